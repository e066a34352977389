#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Shows that the Debian packages work on a bare Debian 12: makes one with debootstrap, installs the packages
# into it, cooks and queries there, and builds and runs programs by CMake and by pkg-config.
#   tests/bare_packages.sh DIRECTORY BUILD     needs root, debootstrap and a network; BUILD: where cpack ran
set -euo pipefail
usage='usage: tests/bare_packages.sh DIRECTORY BUILD'
root=${1:?$usage} build=${2:?$usage}
source=$(cd "$(dirname "$0")/.." && pwd)
[ "$(id -u)" -eq 0 ] || { echo "needs root: it makes and enters a Debian folder" >&2; exit 1; }
[ -e "$root" ] && { echo "$root exists: name a folder that does not" >&2; exit 1; }

debootstrap --variant=minbase bookworm "$root" >/dev/null
mount -t proc proc "$root/proc"
mount -t devpts devpts "$root/dev/pts" # apt writes its log by a terminal
trap 'umount "$root/dev/pts" "$root/proc"' EXIT
cp /etc/resolv.conf /etc/hosts "$root/etc/"
run() {
  echo "== $*"
  chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C \
    DEBIAN_FRONTEND=noninteractive "$@"
}
apt_install() { run apt-get install -y -qq --no-install-recommends "$@" >"$root/log" || { tail "$root/log"; exit 1; }; }

mkdir "$root/packages"
cp "$build"/boxtree_*.deb "$build"/libboxtree*.deb "$root/packages/"
cp -r "$source/samples" "$root/samples"
run apt-get update -qq

# The command line alone needs nothing else of ours.
program=("$root"/packages/boxtree_*.deb)
apt_install "${program[@]#"$root"}"
run boxtree cook /samples/meshes/level.obj -o /level.bxt
run boxtree query /level.bxt ray --origin 0,0,10 --direction 0,0,-1

# Programs: the packages name all that they need but compiler and build tools.
libraries=("$root"/packages/libboxtree*.deb)
apt_install "${libraries[@]#"$root"}" g++ cmake make pkg-config
run cmake -S /samples/game -B /game -DCMAKE_BUILD_TYPE=Release
run cmake --build /game
run /game/game
cat >"$root/plain.cpp" <<'CODE'
#include <boxtree/boxtree.h>
int main(int, char** argv) {
  const auto file = boxtree::File::open(argv[1]);
  if (!file) return 1;
  const auto tree = boxtree::Tree::bind(*file);
  return tree.ok() && boxtree::closest_hit(*tree, {{0, 0, 10}, {0, 0, -1}}) ? 0 : 2;
}
CODE
# shellcheck disable=SC2016 # expanded there
run bash -c 'g++ -std=c++20 /plain.cpp -o /plain $(pkg-config --cflags --libs boxtree)'
run /plain /level.bxt
cp "$source/samples/c/first_ray.c" "$root/plain.c"
# shellcheck disable=SC2016 # expanded there
run bash -c 'gcc -std=c99 -pedantic-errors /plain.c -o /plain_c $(pkg-config --cflags --libs boxtree_c)'
run /plain_c /level.bxt
run apt-get purge -y -qq boxtree 'libboxtree*' >/dev/null
left=$(find "$root/usr" "$root/etc" -path '*boxtree*' | head)
[ -z "$left" ] || { echo "left behind: $left"; exit 1; }
echo "the packages work on a bare Debian 12"
