// SPDX-License-Identifier: MIT
// An open .bxt file: checked header and section table over mapped bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include <boxtree/error.h>
#include <boxtree/export.h>
#include <boxtree/kinds.h>
#include <boxtree/memory.h>

namespace boxtree {

class OpenFile;
struct Member;

/// How a file is opened.
struct OpenOptions {
  /// Read the file into private memory instead of mapping it [default false]: for files that other
  /// programs may modify in place. On Linux, from 8 MB on and without `memory`, that is in huge
  /// pages if the system has any. Of open(path) alone; bytes in memory are used where they are.
  bool copy = false;
  /// Check the XXH3 of every section [default false]: reads the whole file.
  bool verify_checksums = false;
  /// Of all that the File owns, a copy included, and of members of a pack [operator new]. Texts of
  /// errors come from operator new always.
  Memory memory = {};
};

/// How an application is going to read a mapped file.
enum class Access : std::uint8_t {
  kNormal,      ///< What files have that no advice was given for: some pages are read ahead.
  kRandom,      ///< Here and there: nothing is read ahead, so a query reads only pages it needs.
  kSequential,  ///< From front to back, as verify_checksums() does: much is read ahead.
  kWillNeed,    ///< All of it, soon: starts reading the whole file in the background.
  kDontNeed,    ///< Nothing for a while: gives the memory back; what is read again is loaded again.
};

/// A .bxt file, or a pack of many, which is used in the same way: its trees are those of all
/// members, in the order of their names. Immutable once open; safe to use from many threads.
/// Move-only; trees bound to it point into its bytes and must not outlive it (moving the File keeps
/// them valid).
class BOXTREE_API File {
 public:
  /// Maps `path` (UTF-8) and checks header and section table; no section is touched, so the cost
  /// does not depend on the size of the file, and that of a pack not on how many trees it has.
  /// Safe for untrusted bytes.
  /// While it is mapped the file must not be truncated in place: replace files by rename, as the
  /// cooker does, or open them with OpenOptions::copy.
  /// Errors: kFileNotFound, kFileUnreadable, kMapFailed, kOutOfMemory (of the bytes of a copy; for
  /// want of the few hundred that a File takes std::bad_alloc is thrown) and the codes 10..29.
  static Result<File> open(const std::string& path, const OpenOptions& options = {});

  /// The same over memory of the caller, which must stay unchanged while the File or a Tree bound
  /// to it lives. Any alignment.
  static Result<File> open(Bytes memory, const OpenOptions& options = {});

  /// Takes the file over; trees bound to it stay valid. One that was moved from may only be
  /// assigned to or destroyed.
  File(File&&) noexcept;
  /// The same, after closing what was open.
  File& operator=(File&&) noexcept;
  /// Unmaps or frees the bytes.
  ~File();

  /// All bytes of the file, as mapped, read or given.
  [[nodiscard]] Bytes bytes() const noexcept;
  /// Tells the system how the whole file will be read. This changes when pages are loaded, never an
  /// answer. Returns whether the system took the advice: not for files that are in memory (a copy,
  /// bytes of the caller), for which nothing is done, and not on systems without madvise().
  /// kNormal, kRandom and kSequential hold until the next of them; kWillNeed and kDontNeed act
  /// once. One system call. Safe from many threads, beside queries, too.
  bool advise(Access access) const noexcept;
  /// How many trees it holds, those of a scene included.
  [[nodiscard]] std::uint32_t tree_count() const noexcept;
  /// Whether it is a pack.
  [[nodiscard]] bool is_pack() const noexcept;
  /// The file that tree `index` is in, and its number there: a member of a pack, which may have a
  /// scene and a cook record of its own; of another file, the same again. Its bytes are those of
  /// this file, which has to live as long. O(sections) of the member. Errors: kTreeIndex; of a
  /// pack, kRecordInvalid and those of open() for the member.
  [[nodiscard]] Result<Member> member(std::uint32_t index) const;
  /// Whether Scene::bind() finds a scene; no pack has one, but its members may.
  [[nodiscard]] bool has_scene() const noexcept;

  /// Name of tree `index`, empty if it has none or the file has no such tree.
  [[nodiscard]] std::string_view tree_name(std::uint32_t index) const noexcept;

  /// Number of the tree with that name; the first if several share it, which those of a pack do
  /// not. O(trees); of a pack O(log(trees)) names. Error: kTreeIndex.
  [[nodiscard]] Result<std::uint32_t> find_tree(std::string_view name) const;

 private:
  friend class OpenFile;
  struct Ends {  // to where its memory came from
    void operator()(const OpenFile* open) const noexcept;
  };
  explicit File(std::unique_ptr<const OpenFile, Ends> open) noexcept;

  std::unique_ptr<const OpenFile, Ends> open_;
};

/// A tree where it is stored.
struct Member {
  File file;           ///< Over the bytes of the file that it was taken from.
  std::uint32_t tree;  ///< The number of the tree in it.
};

/// Whether the bytes of every section have the checksum of the section table; reads the whole file.
/// Error: kChecksumMismatch.
BOXTREE_API Status verify_checksums(const File& file);

}  // namespace boxtree
