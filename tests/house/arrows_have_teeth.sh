#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A check that cannot fail proves nothing: plants an include against the arrows and expects a no.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/format" "$work/runtime"
echo '#include <cstdint>' >"$work/format/good.h"
echo '#include <Eigen/Core>' >"$work/runtime/good.h"
bash "$here/check_arrows.sh" "$work"
echo '#include <boxtree/runtime/boxtree.h>' >"$work/format/bad.h"
if bash "$here/check_arrows.sh" "$work"; then echo "the check missed format -> runtime"; exit 1; fi
rm "$work/format/bad.h"
echo '#include <boxtree/cooker/cook.h>' >"$work/runtime/bad.h"
if bash "$here/check_arrows.sh" "$work"; then echo "the check missed runtime -> cooker"; exit 1; fi
echo "teeth shown"
