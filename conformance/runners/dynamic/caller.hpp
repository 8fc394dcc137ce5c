// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <rr/dynamic.hpp>
#include <string_view>

#include "conformance/runners/shared/caller.hpp"

namespace rr::conformance {

/// The members of an object by name, with run-time values.
class DynamicCaller final : public Caller {
 public:
  DynamicCaller(const Adapters& none, dynamic::Object object)
      : Caller(none), object_(std::move(object)), definitions_(object_.types()) {}

  Json get(std::string_view property) override;
  void set(std::string_view property, const Json& value) override;
  Json call(std::string_view function, const Json& arguments) override;
  Held objref(std::string_view member, const Json& index) override;
  Subscription listen(std::string_view event, std::function<void(Json)> handler) override;
  std::unique_ptr<PlannedPipe> pipe(std::string_view member, std::int32_t index,
                                    const Arrive& arrive) override;
  std::unique_ptr<PlannedWire> wire(std::string_view member) override;
  std::unique_ptr<PlannedMemory> memory(std::string_view member) override;
  std::unique_ptr<PlannedGenerator> generate(std::string_view function,
                                             const Json& arguments) override;
  void set_callback(std::string_view member, std::function<Json(Json)> answer) override;

 private:
  [[nodiscard]] dynamic::List arguments_of(const dynamic::MemberDescription& member,
                                           const Json& arguments) const;
  const dynamic::Object object_;
  const dynamic::Definitions definitions_;
};

}  // namespace rr::conformance
