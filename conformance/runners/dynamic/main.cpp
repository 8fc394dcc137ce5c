// SPDX-License-Identifier: Apache-2.0
// The runner of the dynamic client: one of three verbs, a line of JSON in, a line of JSON out,
// until its input ends. The definitions are for single values; services send their own.
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <iterator>
#include <string>
#include <vector>

#include "conformance/runners/cpp/call.hpp"
#include "conformance/runners/dynamic/binding.hpp"
#include "conformance/runners/dynamic/codec.hpp"

namespace {

using rr::conformance::Json;

rr::dynamic::Definitions read_folder(const std::string& folder) {
  std::vector<std::string> texts;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::ifstream file(entry.path(), std::ios::binary);
    texts.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return rr::dynamic::Definitions(texts);
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

int main(int argc, char** argv) {
  const std::string verb = argc == 3 ? argv[2] : "";
  if (verb == "call") {
    rr::conformance::DynamicBinding binding;
    rr::conformance::CallingNode node(binding);
    answer_lines([&](const Json& request) { return node.answer(request); });
  } else if (verb == "decode" || verb == "encode") {
    const rr::conformance::DynamicCodec codec(read_folder(argv[1]));
    answer_lines([&](const Json& request) {
      return verb == "decode" ? decode(codec, request) : encode(codec, request);
    });
  } else {
    std::cerr << "usage: conformance_dynamic_runner DEFINITIONS decode|encode|call\n";
    return 2;
  }
  return 0;
}
