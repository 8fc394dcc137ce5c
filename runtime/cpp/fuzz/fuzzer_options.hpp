// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <vector>

namespace rr::fuzz {

/// Puts options of libFuzzer before those of the command line, which count more. To be called once.
inline void add_fuzzer_options(int* count, char*** arguments,
                               std::initializer_list<const char*> options) {
  static std::vector<char*> all;
  all.assign(*arguments, *arguments + *count);
  for (const char* const option : options) {
    all.insert(all.begin() + 1, const_cast<char*>(option));  // nobody writes to it
  }
  *count = static_cast<int>(all.size());
  all.push_back(nullptr);
  *arguments = all.data();
}

/// Without its own search for leaks after each input: a node keeps things beyond the end of a
/// connection, which would make it search every time. The exchanges do it now and then.
inline constexpr const char* no_leaks = "-detect_leaks=0";

}  // namespace rr::fuzz
