// SPDX-License-Identifier: Apache-2.0
// The runner of the dynamic client: a line of JSON in, a line of JSON out, until its input ends. It
// has the client's role only.
#include <exception>
#include <iostream>
#include <string>

#include "conformance/runners/cpp/call.hpp"
#include "conformance/runners/dynamic/binding.hpp"

int main(int argc, char** argv) {
  using rr::conformance::Json;
  if (argc != 2 || std::string(argv[1]) != "call") {
    std::cerr << "usage: conformance_dynamic_runner call\n";
    return 2;
  }
  rr::conformance::DynamicBinding binding;
  rr::conformance::CallingNode node(binding);
  for (std::string line; std::getline(std::cin, line);) {
    Json result;
    try {
      result = node.answer(Json::parse(line));
    } catch (const std::exception& error) {
      result = {{"error", error.what()}};
    }
    std::cout << result.dump(-1, ' ', false, Json::error_handler_t::replace) << "\n" << std::flush;
  }
  return 0;
}
