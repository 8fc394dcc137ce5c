// SPDX-License-Identifier: Apache-2.0
#include "gateway/value_handler.hpp"

#include <utility>

namespace rr::gateway {
namespace {

constexpr const char* of_values = "values: ";

}  // namespace

ValueHandler::ValueHandler(Worker& worker, const Carrier& carrier, Log log, Actions actions)
    : worker_(worker), carrier_(carrier), log_(std::move(log)), actions_(std::move(actions)) {}

void ValueHandler::on_message(Message message) {
  if (!worker_.has_room()) return;
  worker_.post([this, message = std::move(message)] { actions_.message(message); });
}

void ValueHandler::on_connected() {
  worker_.post([this] {
    reason_.clear();
    log_(LogLevel::info, of_values + ("connected to " + carrier_.url()));
    actions_.connected();
  });
}

void ValueHandler::on_disconnected(const std::string& reason) {
  worker_.post([this, reason] {
    refusals_.clear();
    if (std::exchange(reason_, reason) != reason) log_(LogLevel::warning, of_values + reason);
    actions_.disconnected();
  });
}

void ValueHandler::on_room() {
  worker_.post([this] { actions_.room(); });
}

void ValueHandler::on_refused(const Refusal& refusal) {
  worker_.post([this, refusal] {
    if (!refusals_.insert(refusal.topic).second) return;
    log_(LogLevel::error, of_values + refusal.text());
  });
}

}  // namespace rr::gateway
