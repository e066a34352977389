// SPDX-License-Identifier: MIT
// Checks what a file says of materials, of single trees and of scenes, and of user data.
#pragma once

#include <functional>
#include <string>

#include <boxtree/file.h>

namespace boxtree::cooker {

/// Calls `add` with each fault of the sections of materials; every fault is kRecordInvalid.
/// Precondition: every tree of the file has been bound.
void check_materials(const File& file, const std::function<void(const std::string& fault)>& add);

/// The same for user data.
void check_user_data(const File& file, const std::function<void(const std::string& fault)>& add);

}  // namespace boxtree::cooker
