#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The programs of samples/c: what they must print follows from the meshes, which samples_test.sh describes. They are compiled by
# themselves, too, as C99 to the letter.
#   c_samples_test.sh BOXTREE FOLDER_OF_PROGRAMS SOURCE_DIR
set -euo pipefail
boxtree=$1 programs=$2 source=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1

for mesh in level crate; do "$boxtree" cook "$source/samples/meshes/$mesh.obj" -o $mesh.bxt >/dev/null; done

tested=
# prints NAME FILE...: the program NAME prints what standard input says.
prints() {
  local name=$1
  shift
  tested+="$name "
  "$programs/$name" "$@" >"$name.out" || { echo "$name failed"; exit 1; }
  diff "$name.out" - || { echo "$name printed something else (left)"; exit 1; }
}
prints first_ray level.bxt <<<"ground at height 0.5, face 2"
# The plates begin at x = 1 and 2; the ball, of radius 0.25, falls from height 2 on the upper one at 0.5. Sunk by 0.125, it meets
# both of its halves in one point, on their diagonal. The crate stands on the upper plate at 0.5, and is above it before.
prints tour level.bxt crate.bxt <<'END'
heights: 0 0 0.25 0.5 0
below the upper plate: 0.25
the ball falls 1.25 to face 2
1 faces, 1 contact, 0.125 deep
the nearest point is 1.5 away
invalid_query: direction: expected finite, and not zero for a ray (NaN, infinite or empty query)
at height 1.5
at height 1
at height 0.5
the crate touches face 2 of Level
pieces of memory in use: 0
END

# No program without a test, and a file that is not there is an error of each.
for program in "$source"/samples/c/*.c; do
  name=$(basename "$program" .c)
  case " $tested" in
    *" $name "*) ;;
    *) echo "$name has no test"; exit 1 ;;
  esac
  if "$programs/$name" none.bxt none.bxt >/dev/null 2>&1; then echo "$name: no error without a file"; exit 1; fi
  lines=$(wc -l <"$program")
  [ "$lines" -lt 150 ] || { echo "$name: $lines lines"; exit 1; }
  if command -v gcc >/dev/null; then
    gcc -std=c99 -pedantic-errors -I "$source/runtime/include" -c "$program" -o "$name.o" 2>"$name.said" && [ ! -s "$name.said" ] ||
      { cat "$name.said"; echo "$name is not of C99"; exit 1; }
  fi
done
"$programs/first_ray" none.bxt 2>said || true
grep -q '^file_not_found: none.bxt' said || { cat said; echo "first_ray says something else"; exit 1; }
echo "every program in C prints what it must"
