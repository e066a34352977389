// SPDX-License-Identifier: MIT
// Which libraries read the meshes that boxtree does not read itself: of assimp a version alone does
// not tell what it was built with, such as draco, which decodes positions.
#pragma once

#include <string>

namespace boxtree::cooker {

/// Names and build ids of the shared object of assimp and of those that it needs, the runtime of
/// the compiler aside: "libassimp.so.5 b1c2..., libdraco.so.7 ...". An object without a build id
/// has the SHA-256 of its file. Equal on machines with the same packages. Empty where assimp is a
/// part of the program, whose version then tells what it has, and on systems without ELF. Read
/// once, from memory; safe for several threads.
[[nodiscard]] const std::string& import_libraries();

}  // namespace boxtree::cooker
