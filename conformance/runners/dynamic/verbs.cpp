// SPDX-License-Identifier: Apache-2.0
#include "conformance/runners/dynamic/verbs.hpp"

#include <string>

#include "conformance/runners/dynamic/binding.hpp"
#include "conformance/runners/dynamic/codec.hpp"
#include "conformance/runners/dynamic/texts.hpp"
#include "conformance/runners/shared/codec_verbs.hpp"
#include "conformance/runners/shared/verbs.hpp"

namespace rr::conformance {

bool answer_verb(const std::string& verb, const std::string& folder) {
  if (verb == "serve") {
    DynamicBinding binding(read_folder(folder));
    answer_serve(binding);
  } else if (verb == "call") {
    DynamicBinding binding;
    answer_call(binding);
  } else if (verb == "both") {
    DynamicBinding service(read_folder(folder));
    DynamicBinding client;
    answer_both(service, client);
  } else if (verb == "decode" || verb == "encode") {
    const DynamicCodec codec(dynamic::Definitions(read_folder(folder)));
    answer_lines([&](const Json& request) {
      return verb == "decode" ? decode(codec, request) : encode(codec, request);
    });
  } else {
    return false;
  }
  return true;
}

}  // namespace rr::conformance
