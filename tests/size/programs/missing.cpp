// SPDX-License-Identifier: MIT
// Must not compile where pair queries were left out.
#include <boxtree/runtime/query/pair.h>
int main() {}
