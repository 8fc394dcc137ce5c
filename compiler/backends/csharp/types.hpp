// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "compiler/backends/csharp/names.hpp"
#include "compiler/model/model.hpp"

/// How the types of a definition are written in C#, and the codecs that carry them.
namespace robdef::csharp {

inline constexpr std::string_view runtime_space = "Robdef.Runtime";

/// A type as generated code writes it.
struct CsType {
  std::string text;     ///< `List<double[]>?`
  std::string codec;    ///< `ValueCodec.Double.Array`
  std::string initial;  ///< behind a property: ` = [];`, or empty where the default will do
};

/// A codec that is made once for the whole file.
struct CodecField {
  std::string name;   ///< `DoubleArrayList`
  std::string type;   ///< what it carries
  std::string value;  ///< what makes it
};

/// Where a type stands.
enum class Place { anywhere, in_pod, in_namedarray };

/// Writes types in one definition's file, and keeps the codecs that they need.
class Types {
 public:
  explicit Types(Names& names) : names_(names) {}

  CsType spell(const model::Type& type, Place place = Place::anywhere);
  /// The item of a memory, or of a namedarray's field.
  CsType item(const model::Type& type);
  /// `double`, `int`, ...; `void` for void.
  std::string number(model::Primitive primitive);
  /// `ValueCodec.Double`
  std::string number_codec(model::Primitive primitive);

  [[nodiscard]] const std::vector<CodecField>& codecs() const { return codecs_; }

 private:
  CsType base(const model::Type& type);
  CsType array(const CsType& item, const model::Type& type, Place place);
  CsType container(const CsType& item, const model::Type& type);
  std::string kept(const model::Type& type, const std::string& text, const std::string& value,
                   Place place);
  std::string value_codec();

  Names& names_;
  std::vector<CodecField> codecs_;
  std::map<std::string, std::string> codec_names_;  // what makes it -> name
};

}  // namespace robdef::csharp
