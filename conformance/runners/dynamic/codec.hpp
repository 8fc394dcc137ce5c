// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rr/dynamic_definitions.hpp>
#include <rr/registry.hpp>
#include <string>
#include <utility>

#include "conformance/runners/shared/codec_verbs.hpp"

namespace rr::conformance {

/// Single values of the types of definitions that were read.
class DynamicCodec final : public ValueCodec {
 public:
  explicit DynamicCodec(dynamic::Definitions definitions) : definitions_(std::move(definitions)) {}
  Json read(const std::string& type, Decoder& decoder, const Element& element) const override;
  void write(const std::string& type, const Json& value, const ElementName& name,
             Writer& writer) const override;
  [[nodiscard]] const TypeRegistry& types() const override { return definitions_.registry(); }

 private:
  const dynamic::Definitions definitions_;
};

}  // namespace rr::conformance
