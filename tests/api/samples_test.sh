#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The examples of the API reference, on meshes cooked here. What they must print follows from the meshes: level.obj is a floor of
# 8 x 8 (face 0) below a stair of two plates, 2 x 2 at height 0.25 (face 1) and 1 x 2 at height 0.5 (face 2); crate.obj is a cube
# of side 1 that stands on its origin.
#   samples_test.sh BOXTREE FOLDER_OF_PROGRAMS SOURCE_DIR
set -euo pipefail
boxtree=$1 programs=$2 source=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1

meshes=$source/samples/meshes
"$boxtree" cook "$meshes/level.obj" -o level.bxt >/dev/null
"$boxtree" cook "$meshes/crate.obj" -o crate.bxt >/dev/null
"$boxtree" cook "$meshes/level.obj" "$meshes/crate.obj" -o both.bxt >/dev/null
"$boxtree" cook "$source/samples/level/level.gltf" -o courtyard.bxt >/dev/null

tested=
# prints NAME FILE...: the program NAME prints what standard input says.
prints() {
  local name=$1
  shift
  tested+="$name "
  "$programs/$name" "$@" >"$name.out" || { echo "$name failed"; exit 1; }
  diff "$name.out" - || { echo "$name printed something else (left)"; exit 1; }
}
# bounds NAME TRUTH FACTOR: the "between A and B" that NAME printed holds the truth, and B is at most A times the factor.
bounds() {
  awk -v truth="$2" -v factor="$3" '/^between/ { found = 1; ok = $2 <= truth && truth <= $4 && $4 <= $2 * factor + 0.0005 }
    END { exit !(found && ok) }' "$1.out" || { echo "$1: bounds that do not hold"; exit 1; }
}

prints first level.bxt <<<"ground at height 0.5, face 2"
# The second goal is seen: the segment ends above the floor, and passes the plates before they begin.
prints ray level.bxt <<'END'
t 9.5, normal (0, 0, 1)
goal at x 2.5: hidden
goal at x -2: seen
END
# Columns at x = -4.5, -3.5, ...: the floor ends at 4; the lower plate is left free from x = 1 to 2 alone.
prints ray_batch level.bxt <<'END'
    -    -    -    -    -    -    -    -    -    -
    - 0.00 0.00 0.00 0.00 0.00 0.00 0.00 0.00    -
    - 0.00 0.00 0.00 0.00 0.00 0.00 0.00 0.00    -
    - 0.00 0.00 0.00 0.00 0.00 0.00 0.00 0.00    -
    - 0.00 0.00 0.00 0.00 0.00 0.25 0.50 0.00    -
    - 0.00 0.00 0.00 0.00 0.00 0.25 0.50 0.00    -
    - 0.00 0.00 0.00 0.00 0.00 0.00 0.00 0.00    -
    - 0.00 0.00 0.00 0.00 0.00 0.00 0.00 0.00    -
    - 0.00 0.00 0.00 0.00 0.00 0.00 0.00 0.00    -
    -    -    -    -    -    -    -    -    -    -
END
# Both halves of the upper plate meet below the ball's center, 0.25 above it.
prints collide level.bxt <<'END'
2 triangles, of one point 1
out by 0.125 along (0.0, 0.0, 1.0)
the body stands free
END
# The capsule's lower end is 0.4 high and 0.2 beside the plate's edge, at height 0.25, when they are 0.25 apart. The crate meets both halves
# of each plate, and the half of the floor that is below it.
prints cast level.bxt <<'END'
walks 2.800 to face 1, pushed back -0.8 along x and 0.6 up
the bullet passes
the crate meets 5 triangles
END
# The gem is 1 high below its middle and lands on the plate at height 0.25 with its tip. On its side it is 0.5 high.
prints hull level.bxt <<'END'
lands on face 1 after 2.750, its middle at height 1.250
face 1: out by 0.125 along (0.0, 0.0, 1.0)
END
prints box level.bxt <<'END'
face 0
face 1
face 2
nothing
END
# The ball around (2.5, 0, 1) touches the lower plate in one point.
"$programs/sphere" level.bxt | sort >sphere.sorted
tested+="sphere "
diff sphere.sorted - <<'END'
face 1 at height 0.25
face 2 at height 0.5
END
# From (0, 0, 2) the floor is 2 away, the lower plate's edge the root of 1 + 1.75^2.
"$programs/closest_point" level.bxt >closest_point.out
tested+="closest_point "
bounds closest_point 2 1.1
diff <(grep -v '^between' closest_point.out) - <<'END'
distance 2 to face 0
within 1.5: nothing
END
# Twelve balls of radius 0.125 from (0, 0, 1.5) straight to (3, 0, 0): the eighth and ninth are within it of the upper plate, those
# after them of the lower one, the last of the floor alone.
prints overlap_batch level.bxt <<'END'
link 0: ---
link 1: ---
link 2: -pp
link 3: ppf
END
# At x = -2 to 2, 0.5, 1.5 and 2.5 high: over the floor, then over the plates at 0.25 and 0.5; within 1.25.
prints point_batch level.bxt <<'END'
 0.50    -    -
 0.50    -    -
 0.50    -    -
 0.25 1.25    -
 0.00 1.00    -
END
# At height 0.5 the crate stands on the upper plate: its bottom and the four sides touch; lower, the sides alone. It is a square
# of side 1 from above, over a plate from x = 2 to 3.
prints pairs level.bxt crate.bxt <<'END'
height 0.625: 0 pairs, free
height 0.5: 5 pairs, touches
  at x 2 to 3, y -0.5 to 0.5, z 0.5 to 0.5
height 0.375: 4 pairs, touches
  at x 2 to 3, y -0.5 to 0.5, z 0.5 to 0.5
END
"$programs/distance" level.bxt crate.bxt >distance.out
tested+="distance "
bounds distance 0.5 1.1
grep -q '^0.500000, from face 2 to face ' distance.out
# Nearer than the distance, both answers and "undecided" are true; without a distance, one is.
"$programs/overlap_within" level.bxt crate.bxt >overlap_within.out
tested+="overlap_within "
diff <(grep 'within 0:' overlap_within.out) - <<'END'
height 0.375, within 0: overlapping
height 0.53125, within 0: disjoint
height 2, within 0: disjoint
END
grep -Eq '^height 0.375, within 0.0625: (overlapping|undecided)$' overlap_within.out
grep -Eq '^height 0.53125, within 0.0625: (disjoint|undecided)$' overlap_within.out
grep -q '^height 2, within 0.0625: disjoint$' overlap_within.out
grep -q '^height 0.375, within 16: undecided$' overlap_within.out
grep -q '^height 2, within 16: disjoint$' overlap_within.out
# Below 0.375: the floor and the lower plate, 64 + 4.
prints traverse level.bxt <<<"68 square metres"
# Step 6 of make_level.py ends at 6 * 0.18 and at z from -4.65 to -4.35; the crate reaches from -4.9 to -4.1, into both neighbours.
# Two higher its lower edge is at y 2.68 and z -4.9; that of step 10 is at 1.8 and -5.55: 0.88 and 0.65 apart. Of 9 and 11 it is 1.12 and 1.18.
prints scene courtyard.bxt <<'END'
Step 6 at height 1.080
meets Step 5
meets Step 6
meets Step 7
1.094 from Step 10
END
# Both triangles of its top, whose middle is 0.5 from that of the view, and whose diagonal passes the latter at 0.05.
prints frustum courtyard.bxt <<'END'
draws Step 6
sees 2 faces
END
# The crate is 1 high; the eastern tile begins at x = 4.
prints assemble level.bxt crate.bxt <<'END'
height 1.0: Chest, user data 42
below it: West
Crate touches East
END
"$programs/errors" level.bxt >errors.out
tested+="errors "
grep -q '^file_not_found: no-such-file.bxt' errors.out
grep -q '^50 invalid_query$' errors.out
prints files both.bxt <<'END'
level: 3 faces, 6 triangles, 8 x 8 x 0.5
crate: 6 faces, 12 triangles, 1 x 1 x 1
the crate is tree 1
END
"$boxtree" cook "$meshes/crate.obj" --external -o external.bxt >/dev/null
prints external external.bxt <<<"t 2, face 1 of my own arrays"
# 2 x 2 of 8 x 8.
prints threads level.bxt <<<"400 of 6400 rays meet the stair"

# No program without a test, and a file that is not there is an error of each.
for program in "$source"/samples/api/*.cpp; do
  name=$(basename "$program" .cpp)
  case " $tested" in
    *" $name "*) ;;
    *) echo "$name has no test"; exit 1 ;;
  esac
  if "$programs/$name" none.bxt none.bxt >/dev/null 2>&1; then echo "$name: no error without a file"; exit 1; fi
done
echo "every example prints what it must"
