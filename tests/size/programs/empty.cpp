// SPDX-License-Identifier: MIT
// What every program has.
#include <cstdio>
int main(int argc, char**) {
  std::printf("%d\n", argc);
}
