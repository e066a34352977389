#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds the API reference into a folder; fails on any warning of Doxygen.
#   build.sh FOLDER [VERSION]
set -euo pipefail
mkdir -p "$1"
BOXTREE_REFERENCE=$(cd "$1" && pwd)
BOXTREE_VERSION=${2:-}
export BOXTREE_REFERENCE BOXTREE_VERSION
cd "$(dirname "$0")/../.."
doxygen docs/api/Doxyfile
