// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

#include "rr/reader.hpp"
#include "rr/varvalue.hpp"
#include "rr/writer.hpp"

/// Packs and unpacks the values of the captures by their type's name, for tests.
namespace conformance::types {

struct CaptureCodec {
  /// Writes the element of a value in the notation of the captures.
  void (*pack)(const nlohmann::json& value, const ::rr::ElementName& name, ::rr::Writer& writer);
  /// Reads an element and writes it again; nothing, with the decoder failed, when it does not fit.
  void (*repack)(::rr::Decoder& decoder, const ::rr::Element& element,
                 const ::rr::ElementName& name, ::rr::Writer& writer);
  ::rr::VarValue (*make_varvalue)(const nlohmann::json& value);
};

/// By the name as definitions spell it, qualified. Throws std::out_of_range.
const CaptureCodec& capture_codec(std::string_view robdef_type);

}  // namespace conformance::types
