// SPDX-License-Identifier: Apache-2.0
#include "conformance/runners/shared/verbs.hpp"

#include <string>

namespace rr::conformance {

void answer_serve(Binding& binding) {
  ServedNode node(binding);
  answer_lines([&](const Json& request) { return node.answer(request); });
}

void answer_call(Binding& binding) {
  CallingNode node(binding);
  answer_lines([&](const Json& request) { return node.answer(request); });
}

void answer_both(Binding& service, Binding& client) {
  // The client's node goes first, as it would in a process of its own.
  ServedNode served(service);
  CallingNode calling(client);
  answer_lines([&](const Json& request) {
    const std::string what = request.at("do");
    if (what == "close_service") return served.answer(request);
    if (what != "start") return calling.answer(request);
    served.answer(request.at("service"));
    return calling.answer(request.at("client"));
  });
}

}  // namespace rr::conformance
