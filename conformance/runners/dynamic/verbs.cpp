// SPDX-License-Identifier: Apache-2.0
#include "conformance/runners/dynamic/verbs.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "conformance/runners/dynamic/binding.hpp"
#include "conformance/runners/dynamic/codec.hpp"
#include "conformance/runners/shared/codec_verbs.hpp"
#include "conformance/runners/shared/verbs.hpp"

namespace rr::conformance {
namespace {

std::vector<std::string> read_folder(const std::string& folder) {
  std::vector<std::string> texts;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::ifstream file(entry.path(), std::ios::binary);
    texts.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return texts;
}

}  // namespace

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
