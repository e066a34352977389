#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Debian 12 packages, in lists, and the one function that installs what of them is missing. Sourced by
# samples/quickstart.sh and tests/run.sh, and a command for other shells:
#   samples/packages.sh install LIST|PACKAGE...     as in: install BUILD_PACKAGES glmark2-data
# shellcheck disable=SC2034 # the lists are read by the scripts that source it

BUILD_PACKAGES="g++ cmake make ninja-build libeigen3-dev libassimp-dev libpugixml-dev libdraco-dev libminizip-dev
  zlib1g-dev libtbb-dev pkg-config liblzma-dev libzstd-dev libssl-dev libcurl4-openssl-dev libcli11-dev libfmt-dev nlohmann-json3-dev libxxhash-dev
  libhwy-dev libtomlplusplus-dev"
SAMPLE_PACKAGES="glmark2-data assimp-testmodels"
TEST_PACKAGES="libgtest-dev libcgal-dev libgmp-dev locales jq python3-xxhash chromium doxygen python3-pil fonts-dejavu-core
  dpkg-dev file parallel groff-base man-db mandoc zsh fish abigail-tools"
# Libraries that boxtree_peers measures beside ours.
PEER_PACKAGES="libembree-dev libbullet-dev libfcl-dev libode-dev"
# Other compilers, standard libraries and machines, for tests/same_bytes/compare_builds.sh.
COMPARE_PACKAGES="clang libc++-dev libc++abi-dev g++-aarch64-linux-gnu qemu-user-static"
# libFuzzer, for tests/fuzz/run.sh.
FUZZ_PACKAGES="clang libclang-rt-14-dev"

# Reads C++ for tests/mutants.
MUTANT_PACKAGES="python3-clang-14"

# install_missing PACKAGE...: installs those that are missing.
install_missing() {
  local missing=() package
  for package in "$@"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q '^install ok installed$' ||
      missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return 0
  local as_root=()
  [ "$(id -u)" -eq 0 ] || as_root=(sudo)
  echo "installing: ${missing[*]}" >&2
  "${as_root[@]}" apt-get update -qq >&2
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -q --no-install-recommends "${missing[@]}" |
    awk '/^(Get:|Setting up )/ { if (++n % 25 == 0) { print "  " n " steps, now " $0; fflush() } }' >&2
}

if [ "${BASH_SOURCE[0]}" = "$0" ]; then
  set -euo pipefail
  lists=$(sed -n 's/^\([A-Z]*_PACKAGES\)=.*/ \1/p' "$0" | tr -d '\n')
  refuse() { echo "samples/packages.sh: $1; usage: samples/packages.sh install LIST|PACKAGE..., with the lists$lists" >&2; exit 1; }
  [ "${1-}" = install ] || refuse "expected install, found '${1-}'"
  [ $# -gt 1 ] || refuse "nothing to install"
  packages=()
  for name in "${@:2}"; do
    case $name in
      *_PACKAGES)
        [ -n "${!name-}" ] || refuse "no list '$name'"
        read -ra list -d '' <<<"${!name}" || true # true only at a delimiter, which a list has none of
        packages+=("${list[@]}")
        ;;
      *[A-Z]*) refuse "no list '$name'" ;; # names of packages are in small letters
      *) packages+=("$name") ;;
    esac
  done
  install_missing "${packages[@]}"
fi
