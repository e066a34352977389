# SPDX-License-Identifier: MIT
# What tests of the command line share; sourced by them.

# expect STATUS COMMAND...: runs it, output in ./out and ./err.
expect() {
  local want=$1 got=0
  shift
  "$@" >out 2>err || got=$?
  if [ "$got" -ne "$want" ]; then
    echo "expected exit $want, got $got: $*"
    cat out err
    exit 1
  fi
}

# same FOUND EXPECTED
same() { [ "$1" = "$2" ] || { echo "expected '$2', found '$1'"; exit 1; }; }
