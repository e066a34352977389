// SPDX-License-Identifier: MIT
// Compiled elsewhere, this is nothing: see sha256_openssl.cpp.
#ifdef _WIN32
#include <algorithm>
#include <limits>
#include <new>
#include <windows.h>
// Windows' own headers need those of windows.h before them.
#include <bcrypt.h>

#include "cooker/farm/sha256.h"

namespace boxtree::cooker {

struct Sha256::Context {
  BCRYPT_HASH_HANDLE hash = nullptr;
};

namespace {

// The system fails here for want of memory alone: the algorithm is built in, and hashes are used
// once.
void check(NTSTATUS status) {
  if (status < 0) throw std::bad_alloc();
}

}  // namespace

void Sha256::Free::operator()(Context* context) const {
  if (context->hash != nullptr) static_cast<void>(::BCryptDestroyHash(context->hash));
  delete context;
}

Sha256::Sha256() : context_(new Context) {
  static const BCRYPT_ALG_HANDLE algorithm = [] {
    BCRYPT_ALG_HANDLE opened = nullptr;
    check(::BCryptOpenAlgorithmProvider(&opened, BCRYPT_SHA256_ALGORITHM, nullptr, 0));
    return opened;
  }();
  check(::BCryptCreateHash(algorithm, &context_->hash, nullptr, 0, nullptr, 0, 0));
}

void Sha256::add(Bytes bytes) {
  while (!bytes.empty()) {
    const auto count =
        static_cast<ULONG>(std::min<std::size_t>(bytes.size(), std::numeric_limits<ULONG>::max()));
    // It reads them, although it takes them as if it wrote.
    auto* const data =
        const_cast<unsigned char*>(reinterpret_cast<const unsigned char*>(bytes.data()));
    check(::BCryptHashData(context_->hash, data, count, 0));
    bytes = bytes.subspan(count);
  }
}

Digest Sha256::finish() {
  Digest digest;
  check(::BCryptFinishHash(context_->hash, reinterpret_cast<unsigned char*>(digest.data()),
                           static_cast<ULONG>(digest.size()), 0));
  return digest;
}

}  // namespace boxtree::cooker
#endif
