// SPDX-License-Identifier: Apache-2.0
// The runner of the dynamic client and service: one of four verbs, a line of JSON in, a line of
// JSON out, until its input ends. Clients read no definitions but those that services send.
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

namespace {

using rr::conformance::Json;

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

int main(int argc, char** argv) {
  const std::string verb = argc == 3 ? argv[2] : "";
  if (verb == "serve") {
    rr::conformance::DynamicBinding binding(read_folder(argv[1]));
    rr::conformance::ServedNode node(binding);
    answer_lines([&](const Json& request) { return node.answer(request); });
  } else if (verb == "call") {
    rr::conformance::DynamicBinding binding;
    rr::conformance::CallingNode node(binding);
    answer_lines([&](const Json& request) { return node.answer(request); });
  } else if (verb == "decode" || verb == "encode") {
    const rr::conformance::DynamicCodec codec(rr::dynamic::Definitions(read_folder(argv[1])));
    answer_lines([&](const Json& request) {
      return verb == "decode" ? decode(codec, request) : encode(codec, request);
    });
  } else {
    std::cerr << "usage: conformance_dynamic_runner DEFINITIONS decode|encode|serve|call\n";
    return 2;
  }
  return 0;
}
