// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rr/reader.hpp>
#include <rr/writer.hpp>
#include <string>

#include "conformance/runners/shared/adapters.hpp"

namespace rr::conformance {

/// Single values by the names of their types.
class ValueCodec {
 public:
  virtual ~ValueCodec() = default;
  /// In the notation of the captures. Throws std::runtime_error when the element does not fit.
  virtual Json read(const std::string& type, Decoder& decoder, const Element& element) const = 0;
  /// Throws rr::Error for what the type cannot hold.
  virtual void write(const std::string& type, const Json& value, const ElementName& name,
                     Writer& writer) const = 0;
  [[nodiscard]] virtual const TypeRegistry& types() const = 0;
};

/// Those of the types that the adapters know.
class AdapterCodec final : public ValueCodec {
 public:
  explicit AdapterCodec(const Adapters& adapters) : adapters_(adapters) {}
  Json read(const std::string& type, Decoder& decoder, const Element& element) const override;
  void write(const std::string& type, const Json& value, const ElementName& name,
             Writer& writer) const override;
  [[nodiscard]] const TypeRegistry& types() const override { return adapters_.types(); }

 private:
  const Adapters& adapters_;
};

/// `decode`: {do: message, hex} gives {decoded}; {do: element, message_version, type, hex} gives
/// {decoded, value}. Throws what makes an answer of {error}.
Json decode(const ValueCodec& codec, const Json& request);

/// `encode`: {do: message, decoded} and {do: element, message_version, decoded} give {hex}; {do:
/// value, message_version, type, value, element_name or element_number, metadata, extended} gives
/// {hex}, or {refused} with the runtime's reason.
Json encode(const ValueCodec& codec, const Json& request);

}  // namespace rr::conformance
