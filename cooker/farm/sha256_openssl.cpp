// SPDX-License-Identifier: MIT
// Compiled on Windows, this is nothing: see sha256_windows.cpp.
#ifndef _WIN32
#include <new>
#include <openssl/evp.h>

#include "cooker/farm/sha256.h"

namespace boxtree::cooker {

struct Sha256::Context {
  EVP_MD_CTX* const library = EVP_MD_CTX_new();
};

namespace {

// OpenSSL fails here for want of memory alone: the digest is built in, and contexts are used once.
void check(int result) {
  if (result != 1) throw std::bad_alloc();
}

}  // namespace

void Sha256::Free::operator()(Context* context) const {
  EVP_MD_CTX_free(context->library);
  delete context;
}

Sha256::Sha256() : context_(new Context) {
  EVP_MD_CTX* const library = context_->library;
  check(library != nullptr ? EVP_DigestInit_ex(library, EVP_sha256(), nullptr) : 0);
}

void Sha256::add(Bytes bytes) {
  check(EVP_DigestUpdate(context_->library, bytes.data(), bytes.size()));
}

Digest Sha256::finish() {
  Digest digest;
  check(EVP_DigestFinal_ex(context_->library, reinterpret_cast<unsigned char*>(digest.data()),
                           nullptr));
  return digest;
}

}  // namespace boxtree::cooker
#endif
