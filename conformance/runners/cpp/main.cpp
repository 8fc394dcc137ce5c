// SPDX-License-Identifier: Apache-2.0
// The C++ runner: one of five verbs, a line of JSON in, a line of JSON out, until its input ends.
#include <iostream>
#include <string>

#include "conformance/runners/cpp/all.hpp"
#include "conformance/runners/shared/codec_verbs.hpp"
#include "conformance/runners/shared/verbs.hpp"

int main(int argc, char** argv) {
  using namespace rr::conformance;
  const std::string verb = argc == 2 ? argv[1] : "";
  Adapters adapters;
  add_all(adapters);
  const AdapterCodec codec(adapters);
  GeneratedBinding binding(adapters);
  if (verb == "decode") {
    answer_lines([&](const Json& request) { return decode(codec, request); });
  } else if (verb == "encode") {
    answer_lines([&](const Json& request) { return encode(codec, request); });
  } else if (verb == "serve") {
    answer_serve(binding);
  } else if (verb == "call") {
    answer_call(binding);
  } else if (verb == "both") {
    answer_both(binding, binding);
  } else {
    std::cerr << "usage: conformance_runner decode|encode|serve|call|both\n";
    return 2;
  }
  return 0;
}
