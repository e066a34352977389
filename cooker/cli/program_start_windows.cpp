// SPDX-License-Identifier: MIT
// The linker reserves the stack (cooker/CMakeLists.txt). Compiled elsewhere, this is nothing: see
// program_start_posix.cpp.
#ifdef _WIN32
#include <cstddef>
#include <cstdio>
#include <fcntl.h>
#include <io.h>
#include <memory>
#include <string>
#include <vector>

#include "cooker/cli/program_start.h"
#include "runtime/file/windows_path.h"
// clang-format off
#include <shellapi.h>  // needs windows.h before it
// clang-format on

namespace boxtree::cooker {
namespace {

struct FreeWords {
  void operator()(wchar_t** words) const { ::LocalFree(words); }
};

// Halves of a surrogate pair that stand alone become U+FFFD, which names no file.
std::string utf8(const wchar_t* word) {
  const int size = ::WideCharToMultiByte(CP_UTF8, 0, word, -1, nullptr, 0, nullptr, nullptr);
  if (size <= 1) return {};  // with a 0 at its end
  std::string text(static_cast<std::size_t>(size), '\0');
  ::WideCharToMultiByte(CP_UTF8, 0, word, -1, text.data(), size, nullptr, nullptr);
  text.pop_back();
  return text;
}

// As the C library has them they are in the code page of the machine.
void take_words(int& argc, char**& argv) {
  static std::vector<std::string> words;
  static std::vector<char*> pointers;
  int count = 0;
  const std::unique_ptr<wchar_t*, FreeWords> wide(
      ::CommandLineToArgvW(::GetCommandLineW(), &count));
  if (wide == nullptr || count < 1) return;
  for (int i = 0; i < count; ++i) words.push_back(utf8(wide.get()[i]));
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  argc = count;
  argv = pointers.data();
}

}  // namespace

void prepare_process(int& argc, char**& argv) {
  for (std::FILE* const stream : {stdin, stdout, stderr}) {
    static_cast<void>(::_setmode(::_fileno(stream), _O_BINARY));
  }
  static_cast<void>(::SetConsoleOutputCP(CP_UTF8));
  take_words(argc, argv);
}

}  // namespace boxtree::cooker
#endif
