// SPDX-License-Identifier: Apache-2.0
// Debian's libc++ for WebAssembly has no exceptions. What would throw one ends the instance by a trap.
#include <cstddef>

extern "C" {
void* __cxa_allocate_exception(std::size_t) { __builtin_trap(); }
void __cxa_throw(void*, void*, void (*)(void*)) { __builtin_trap(); }
}
