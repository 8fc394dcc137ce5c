// SPDX-License-Identifier: Apache-2.0
// The C++ runner: one of four verbs, a line of JSON in, a line of JSON out, until its input ends.
#include <exception>
#include <functional>
#include <iostream>
#include <string>

#include "conformance/runners/cpp/all.hpp"
#include "conformance/runners/shared/call.hpp"
#include "conformance/runners/shared/codec_verbs.hpp"
#include "conformance/runners/shared/serve.hpp"

namespace {

using rr::conformance::Json;

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

Json answer_both(rr::conformance::ServedNode& served, rr::conformance::CallingNode& calling,
                 const Json& request) {
  const std::string what = request.at("do");
  if (what == "close_service") return served.answer(request);
  if (what != "start") return calling.answer(request);
  served.answer(request.at("service"));
  return calling.answer(request.at("client"));
}

}  // namespace

int main(int argc, char** argv) {
  const std::string verb = argc == 2 ? argv[1] : "";
  rr::conformance::Adapters adapters;
  add_all(adapters);
  const rr::conformance::AdapterCodec codec(adapters);
  if (verb == "decode") {
    answer_lines([&](const Json& request) { return decode(codec, request); });
  } else if (verb == "encode") {
    answer_lines([&](const Json& request) { return encode(codec, request); });
  } else if (verb == "serve") {
    rr::conformance::GeneratedBinding binding(adapters);
    rr::conformance::ServedNode node(binding);
    answer_lines([&](const Json& request) { return node.answer(request); });
  } else if (verb == "call") {
    rr::conformance::GeneratedBinding binding(adapters);
    rr::conformance::CallingNode node(binding);
    answer_lines([&](const Json& request) { return node.answer(request); });
  } else if (verb == "both") {
    // The client's node goes first, as it would in a process of its own.
    rr::conformance::ServedNode served(adapters);
    rr::conformance::GeneratedBinding binding(adapters);
    rr::conformance::CallingNode calling(binding);
    answer_lines([&](const Json& request) { return answer_both(served, calling, request); });
  } else {
    std::cerr << "usage: conformance_runner decode|encode|serve|call|both\n";
    return 2;
  }
  return 0;
}
