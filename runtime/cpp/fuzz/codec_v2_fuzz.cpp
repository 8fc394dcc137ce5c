// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/fuzz/codec_fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  rr::fuzz_message(data, size, rr::MessageVersion::v2);
  return 0;
}
