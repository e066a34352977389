// SPDX-License-Identifier: MIT
// A source for the target that precompiles headers of the tests.
