#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The README's line that installs packages does so from any shell: those that are missing, lists and single
# ones. In a folder of programs in the place of Debian's, which install nothing.
#   packages_test.sh SOURCE
set -euo pipefail
source=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "packages: $*"; exit 1; }
mkdir "$work/bin"
program() { { echo '#!/bin/sh'; cat; } >"$work/bin/$1" && chmod +x "$work/bin/$1"; }
# All is installed but cmake and glmark2-data.
program dpkg-query <<'CODE'
for package in "$@"; do :; done
case $package in cmake | glmark2-data) exit 1 ;; esac
echo 'install ok installed'
CODE
program apt-get <<CODE
echo "\$*" >>"$work/called"
CODE
program sudo <<'CODE'
exec "$@"
CODE
export PATH=$work/bin:$PATH
cd "$source"
line=$(grep -x 'samples/packages.sh install .*' README.md) || fail "the README does not install packages"
for shell in bash dash zsh fish; do
  command -v $shell >/dev/null || continue
  : >"$work/called"
  $shell -c "$line" 2>"$work/err" || fail "$shell: $(cat "$work/err")"
  grep -qx 'installing: cmake glmark2-data' "$work/err" || fail "$shell: $(cat "$work/err")"
  grep -q 'install .* cmake glmark2-data$' "$work/called" || fail "$shell: called: $(cat "$work/called")"
done

refused() {
  if samples/packages.sh "${@:2}" 2>"$work/err"; then fail "takes ${*:2}"; fi
  grep -qF "samples/packages.sh: $1; usage: " "$work/err" || fail "${*:2}: $(cat "$work/err")"
}
: >"$work/called"
refused "expected install, found ''"
refused "expected install, found 'cmake'" cmake
refused "nothing to install" install
grep -q 'LIST|PACKAGE..., with the lists BUILD_PACKAGES SAMPLE_PACKAGES TEST_PACKAGES ' "$work/err" || fail "names no lists"
read -ra lists < <(sed -n 's/.*with the lists //p' "$work/err")
for list in "${lists[@]}"; do
  grep -q "^$list=" samples/packages.sh || fail "no list $list"
done
refused "no list 'BILD_PACKAGES'" install BILD_PACKAGES
[ ! -s "$work/called" ] || fail "installs what it refuses"
