// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <rr/dynamic_service.hpp>
#include <string>

#include "conformance/runners/shared/object_script.hpp"

namespace rr::conformance {

/// What an object without generated code is told to do. The object keeps its script.
class DynamicScript final : public ObjectScript,
                            public std::enable_shared_from_this<DynamicScript> {
 public:
  static dynamic::ServedObject serve(const dynamic::Definitions& definitions,
                                     const std::string& type, Json node);

  DynamicScript(dynamic::Definitions definitions, Json node)
      : ObjectScript(std::move(node)), definitions_(std::move(definitions)) {}
  ~DynamicScript() override { finish(); }

 private:
  void add_members();
  void add_property(const dynamic::MemberDescription& member);
  void add_function(const dynamic::MemberDescription& member);
  void add_event(const std::string& name);
  void add_pipe(const dynamic::MemberDescription& member);
  void add_wire(const dynamic::MemberDescription& member);
  void add_callback(const dynamic::MemberDescription& member);
  void add_objref(const std::string& name);
  void add_memory(const dynamic::MemberDescription& member);

  [[nodiscard]] dynamic::ServedObject object() const { return object_.lock(); }
  [[nodiscard]] dynamic::List arguments_of(const std::string& member, const Json& json) const;
  [[nodiscard]] VarValue read_parameter(const Json& json) const override;
  [[nodiscard]] std::shared_ptr<rr::Skeleton> make_child(const std::string& type,
                                                         Json node) const override;

  const dynamic::Definitions definitions_;
  dynamic::WeakServedObject object_;
};

}  // namespace rr::conformance
