// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "rr/definition.hpp"
#include "rr/type.hpp"
#include "runtime/cpp/src/client/session.hpp"
#include "runtime/cpp/src/endpoint/slot_terms.hpp"

namespace rr::client {

/// The request that connects a wire, or changes how its values come: with an element that says how,
/// but for a wire that is connected as all services know it.
class WireRequest {
 public:
  WireRequest(std::string_view element, endpoint::SlotMode mode)
      : mode_(static_cast<std::uint32_t>(mode)),
        has_element_(mode != endpoint::SlotMode::messages ||
                     element == endpoint::slots_again_element),
        parameters_{{element, &type_of<std::uint32_t>}},
        values_{&mode_} {}
  WireRequest(const WireRequest&) = delete;
  WireRequest& operator=(const WireRequest&) = delete;

  /// To be used while this and the texts exist.
  [[nodiscard]] Outgoing to(std::string_view path, std::string_view member) const {
    Outgoing request{EntryType::wire_connect_req, path, member};
    if (!has_element_) return request;
    request.parameters = parameters_;
    request.values = values_;
    return request;
  }

 private:
  const std::uint32_t mode_;
  const bool has_element_;
  const Parameter parameters_[1];
  const void* const values_[1];
};

}  // namespace rr::client
