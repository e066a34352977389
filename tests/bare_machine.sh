#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Shows that every command of the README works on a bare Debian 12: makes one with debootstrap (a
# shell, git and apt), clones the committed state into it and runs them there, in their order. The builds print no
# warning.
#   tests/bare_machine.sh DIRECTORY     needs root, debootstrap, a network, 3 GB and some 20 minutes
set -euo pipefail
root=${1:?usage: tests/bare_machine.sh DIRECTORY}
source=$(cd "$(dirname "$0")/.." && pwd)
[ "$(id -u)" -eq 0 ] || { echo "needs root: it makes and enters a Debian folder" >&2; exit 1; }
[ -e "$root" ] && { echo "$root exists: name a folder that does not" >&2; exit 1; }

debootstrap --variant=minbase --include=git bookworm "$root" >/dev/null
mount -t proc proc "$root/proc"
mount -t devpts devpts "$root/dev/pts" # a test looks at what a terminal is shown
trap 'umount "$root/dev/pts" "$root/proc"' EXIT
cp /etc/resolv.conf /etc/hosts "$root/etc/"
git clone --quiet "$source" "$root/boxtree"

run() {
  echo "== $*"
  chroot "$root" /usr/bin/env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C "$@"
}
python3 "$source/tests/docs/blocks.py" "$source/README.md" sh >"$root/readme.sh"
run bash -c 'cd /boxtree; sudo() { "$@"; }; set -euo pipefail; . /readme.sh' 2>&1 | tee "$root/readme.log"
if grep 'warning: .*\[-W' "$root/readme.log"; then
  echo "the compiler warns" >&2
  exit 1
fi
echo "the commands of the README work on a bare Debian 12"
