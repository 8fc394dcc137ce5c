// SPDX-License-Identifier: Apache-2.0
// Relacy's headers replace `new` and `delete`, but not the form of `delete` that knows the size.
#include <cstddef>

#include "runtime/cpp/models/relacy.hpp"

void operator delete(void* memory, std::size_t /*size*/) noexcept { ::operator delete(memory); }
void operator delete[](void* memory, std::size_t /*size*/) noexcept { ::operator delete[](memory); }
