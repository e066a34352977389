// SPDX-License-Identifier: MIT
// What the program sets up before it reads its command line.
#pragma once

namespace boxtree::cooker {

/// Makes the stack as large as queries need it, so that too little memory is found here, and keeps
/// the numbers of standard streams that are closed from files that are opened later. On Windows,
/// standard streams are made streams of bytes in UTF-8, and the words of the command line UTF-8
/// that lives until the program ends, of which named_path() makes names of files. Throws
/// std::bad_alloc.
void prepare_process(int& argc, char**& argv);

}  // namespace boxtree::cooker
