// SPDX-License-Identifier: MIT
// How files are opened on Windows: names in UTF-8 of any length, what is no file, and who may write meanwhile.
//   windows_files FILE.bxt      run in a folder of its own
#include <stdio.h>
#include <string.h>
#include <windows.h>

#include <boxtree_c.h>

static int failures = 0;

static void expect(const char* what, bxt_status found, bxt_status expected) {
  if (found == expected) return;
  printf("%s: expected %s, found %s\n", what, bxt_error_name(expected), bxt_error_name(found));
  ++failures;
}

// How opening ends; a file that opens is closed again.
static bxt_status opened(const char* path, bool copy) {
  bxt_file_options options = {.struct_size = sizeof options, .copy = copy};
  bxt_error error = {.struct_size = sizeof error};
  bxt_file* file = NULL;
  const bxt_status status = bxt_file_open(path, &options, &file, &error);
  if (status == BXT_OK) {
    if (bxt_file_tree_count(file) == 0) ++failures;
    bxt_file_close(file);
  } else if (strstr(error.message, bxt_error_name(status)) == NULL || error.message_length < strlen(path)) {
    printf("%s: says only '%s'\n", path, error.message);
    ++failures;
  }
  return status;
}

// Whether somebody else may open the file to write.
static bool may_be_written(const wchar_t* path) {
  const HANDLE file = CreateFileW(path, GENERIC_WRITE, FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE, NULL,
                                  OPEN_EXISTING, FILE_ATTRIBUTE_NORMAL, NULL);
  if (file == INVALID_HANDLE_VALUE) return false;
  CloseHandle(file);
  return true;
}

static void make_empty(const wchar_t* path) {
  CloseHandle(CreateFileW(path, GENERIC_WRITE, 0, NULL, CREATE_ALWAYS, FILE_ATTRIBUTE_NORMAL, NULL));
}

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  expect("a file", opened(argv[1], false), BXT_OK);
  expect("a copy", opened(argv[1], true), BXT_OK);

  // U+00E4, U+6728 and U+1F333 in UTF-8 and UTF-16.
  const wchar_t* const named = L"b\x00e4um \x6728 \xd83c\xdf33.bxt";
  CopyFileA(argv[1], "plain.bxt", FALSE);
  CopyFileW(L"plain.bxt", named, FALSE);
  expect("a name in UTF-8", opened("b\xc3\xa4um \xe6\x9c\xa8 \xf0\x9f\x8c\xb3.bxt", false), BXT_OK);
  expect("a name that is not UTF-8", opened("b\xe4um.bxt", false), BXT_FILE_NOT_FOUND);
  expect("a name that is not there", opened("nothing.bxt", false), BXT_FILE_NOT_FOUND);
  expect("an empty name", opened("", false), BXT_FILE_NOT_FOUND);

  // Folders whose path, or whose path from the root, becomes longer than MAX_PATH.
  wchar_t folder[1024], part[64];
  char utf8[2048], path[2048] = "";
  wcscpy(folder, L"\\\\?\\");
  GetCurrentDirectoryW(512, folder + 4);
  for (int i = 0; i < 12; ++i) {
    swprintf(part, 64, L"\\a folder with a name of some length %02d", i);
    wcscat(folder, part);
    CreateDirectoryW(folder, NULL);
    snprintf(utf8, sizeof utf8, "a folder with a name of some length %02d/", i);
    strcat(path, utf8);
    wchar_t deep[1100];
    swprintf(deep, 1100, L"%ls\\deep.bxt", folder);
    CopyFileW(L"plain.bxt", deep, FALSE);
    snprintf(utf8, sizeof utf8, "%sdeep.bxt", path);
    expect(utf8, opened(utf8, false), BXT_OK);
  }

  expect("a folder", opened("a folder with a name of some length 00", false), BXT_FILE_UNREADABLE);
  expect("a device", opened("NUL", false), BXT_FILE_UNREADABLE);
  make_empty(L"empty.bxt");
  expect("an empty file", opened("empty.bxt", false), BXT_TRUNCATED);
  expect("an empty file, copied", opened("empty.bxt", true), BXT_TRUNCATED);

  // Mapped, nobody may write to it; copied, and closed, everybody.
  bxt_file* file = NULL;
  bxt_file_options options = {.struct_size = sizeof options};
  expect("a mapped file", bxt_file_open("plain.bxt", &options, &file, NULL), BXT_OK);
  if (may_be_written(L"plain.bxt")) printf("a mapped file may be written\n"), ++failures;
  bxt_file_close(file);
  options.copy = true;
  expect("a copied file", bxt_file_open("plain.bxt", &options, &file, NULL), BXT_OK);
  if (!may_be_written(L"plain.bxt")) printf("a copied file may not be written\n"), ++failures;
  bxt_file_close(file);
  return failures == 0 ? 0 : 1;
}
