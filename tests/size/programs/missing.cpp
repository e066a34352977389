// SPDX-License-Identifier: MIT
// Must not compile where pair queries were left out.
#include <boxtree/contact.h>
int main() {}
