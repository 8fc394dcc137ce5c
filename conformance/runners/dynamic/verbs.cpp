// SPDX-License-Identifier: Apache-2.0
#include "conformance/runners/dynamic/verbs.hpp"

#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <iterator>
#include <string>
#include <vector>

#include "conformance/runners/dynamic/binding.hpp"
#include "conformance/runners/dynamic/codec.hpp"
#include "conformance/runners/shared/call.hpp"
#include "conformance/runners/shared/serve.hpp"

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

void answer_lines(const std::function<Json(const Json&)>& answer) {
  for (std::string line; std::getline(std::cin, line);) {
    Json result;
    try {
      result = answer(Json::parse(line));
    } catch (const std::exception& error) {
      result = {{"error", error.what()}};
    }
    std::cout << result.dump(-1, ' ', false, Json::error_handler_t::replace) << "\n" << std::flush;
  }
}

}  // namespace

bool answer_verb(const std::string& verb, const std::string& folder) {
  if (verb == "serve") {
    DynamicBinding binding(read_folder(folder));
    ServedNode node(binding);
    answer_lines([&](const Json& request) { return node.answer(request); });
  } else if (verb == "call") {
    DynamicBinding binding;
    CallingNode node(binding);
    answer_lines([&](const Json& request) { return node.answer(request); });
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
