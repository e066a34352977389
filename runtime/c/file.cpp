// SPDX-License-Identifier: MIT
// Files, in C.
#include <boxtree_c.h>
#include <string_view>
#include <utility>

#include <boxtree/file.h>

#include "runtime/c/call.h"
#include "runtime/c/handle.h"

using namespace boxtree;
using namespace boxtree::c;

namespace {

// Opens what `open(options)` opens.
template <class Open>
bxt_status open_file(const bxt_file_options* given, bxt_file** file, bxt_error* error, Open open) {
  bxt_file_options read = {};
  Allocation allocation;
  if (!read_struct(given, read)) return refuse(error, "options: struct_size");
  if (!Allocation::read(read.allocator, allocation)) return refuse(error, "options: allocator");
  return guarded(error, [&] {
    Result<File> opened = open(OpenOptions{.copy = read.copy,
                                           .verify_checksums = read.verify_checksums,
                                           .memory = allocation.memory()});
    if (!opened) return fail(error, opened.error());
    *file = allocation.make<bxt_file>(std::move(*opened));
    return bxt_status{BXT_OK};
  });
}

}  // namespace

bxt_status bxt_file_open(const char* path, const bxt_file_options* options, bxt_file** file,
                         bxt_error* error) {
  if (const char* name = first_null("path", path, "file", file)) return refuse_null(error, name);
  return open_file(options, file, error,
                   [&](const OpenOptions& read) { return File::open(path, read); });
}

bxt_status bxt_file_open_memory(const void* bytes, size_t size, const bxt_file_options* options,
                                bxt_file** file, bxt_error* error) {
  if (const char* name = first_null("bytes", bytes, "file", file)) return refuse_null(error, name);
  return open_file(options, file, error, [&](const OpenOptions& read) -> Result<File> {
    if (read.copy) return Error{Errc::kInvalidQuery, "options: copy, of what is in memory"};
    return File::open(Bytes(static_cast<const std::byte*>(bytes), size), read);
  });
}

void bxt_file_close(bxt_file* file) {
  Allocation::release(file);
}

uint32_t bxt_file_tree_count(const bxt_file* file) {
  return file->inside.tree_count();
}

bool bxt_file_is_pack(const bxt_file* file) {
  return file->inside.is_pack();
}

bxt_status bxt_file_open_member(const bxt_file* file, uint32_t tree, bxt_file** member,
                                uint32_t* number, bxt_error* error) {
  if (const char* name = first_null("file", file, "member", member))
    return refuse_null(error, name);
  return guarded(error, [&] {
    Result<Member> opened = file->inside.member(tree);
    if (!opened) return fail(error, opened.error());
    *member = file->allocation.make<bxt_file>(std::move(opened->file));
    if (number != nullptr) *number = opened->tree;
    return bxt_status{BXT_OK};
  });
}

bool bxt_file_has_scene(const bxt_file* file) {
  return file->inside.has_scene();
}

size_t bxt_file_tree_name(const bxt_file* file, uint32_t tree, char* buffer, size_t capacity) {
  return copy_text(file->inside.tree_name(tree), buffer, capacity);
}

bxt_status bxt_file_find_tree(const bxt_file* file, const char* name, uint32_t* tree,
                              bxt_error* error) {
  if (const char* null = first_null("file", file, "name", name, "tree", tree))
    return refuse_null(error, null);
  return guarded(error, [&] {
    const Result<std::uint32_t> found = file->inside.find_tree(name);
    if (found) *tree = *found;
    return finish(found, error);
  });
}

bxt_status bxt_file_verify_checksums(const bxt_file* file, bxt_error* error) {
  if (file == nullptr) return refuse_null(error, "file");
  return guarded(error, [&] { return finish(verify_checksums(file->inside), error); });
}

bool bxt_file_advise(const bxt_file* file, uint32_t access) {
  if (access > BXT_ACCESS_DONT_NEED) return false;
  return file->inside.advise(static_cast<Access>(access));
}
