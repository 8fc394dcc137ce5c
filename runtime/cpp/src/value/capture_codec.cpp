// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/value/capture_codec.hpp"

#include <map>
#include <string_view>

#include "rr/codec.hpp"
#include "runtime/cpp/src/value/capture_values.hpp"

namespace conformance::types {

void from_capture(const json& from, Sample& to) {
  visit_fields(to, [&](const char* name, auto& field) { from_capture(from.at(name), field); });
}
void from_capture(const json& from, Reading& to) {
  visit_fields(to, [&](const char* name, auto& field) { from_capture(from.at(name), field); });
}
void from_capture(const json& from, Counter& to) {
  visit_fields(to, [&](const char* name, auto& field) { from_capture(from.at(name), field); });
}
void from_capture(const json& from, Stats& to) {
  visit_fields(to, [&](const char* name, auto& field) { from_capture(from.at(name), field); });
}
void from_capture(const json& from, Leaf& to) {
  visit_fields(to, [&](const char* name, auto& field) { from_capture(from.at(name), field); });
}
void from_capture(const json& from, Tree& to) {
  visit_fields(to, [&](const char* name, auto& field) { from_capture(from.at(name), field); });
}
void from_capture(const json& from, Everything& to) {
  visit_fields(to, [&](const char* name, auto& field) { from_capture(from.at(name), field); });
}

namespace {

template <class T>
void pack(const json& value, const ::rr::ElementName& name, ::rr::Writer& writer) {
  T typed{};
  from_capture(value, typed);
  ::rr::type_of<T>.write(writer, name, &typed);
}
template <class T>
void repack(::rr::Decoder& decoder, const ::rr::Element& element, const ::rr::ElementName& name,
            ::rr::Writer& writer) {
  T typed{};
  if (::rr::type_of<T>.read(decoder, element, &typed)) ::rr::type_of<T>.write(writer, name, &typed);
}
template <class T>
::rr::VarValue make_varvalue(const json& value) {
  T typed{};
  from_capture(value, typed);
  return ::rr::VarValue(std::move(typed));
}
template <class T>
constexpr CaptureCodec codec{pack<T>, repack<T>, make_varvalue<T>};

const std::map<std::string_view, CaptureCodec> codecs = {
    {"bool", codec<bool>},
    {"bool[*]", codec<::rr::MultiArray<bool>>},
    {"bool[]", codec<::rr::Array<bool>>},
    {"bool{list}", codec<std::optional<std::vector<bool>>>},
    {"cdouble", codec<std::complex<double>>},
    {"cdouble[*]", codec<::rr::MultiArray<std::complex<double>>>},
    {"cdouble[]", codec<::rr::Array<std::complex<double>>>},
    {"conformance.types.Counter", codec<Counter>},
    {"conformance.types.Everything", codec<std::optional<Everything>>},
    {"conformance.types.Knots", codec<Knots>},
    {"conformance.types.Leaf", codec<std::optional<Leaf>>},
    {"conformance.types.Mode", codec<Mode>},
    {"conformance.types.Mode{list}", codec<std::optional<std::vector<Mode>>>},
    {"conformance.types.Pixel[*]", codec<::rr::MultiArray<Pixel>>},
    {"conformance.types.Reading", codec<Reading>},
    {"conformance.types.Sample", codec<Sample>},
    {"conformance.types.Sample[*]", codec<::rr::MultiArray<Sample>>},
    {"conformance.types.Sample[2]", codec<std::array<Sample, 2>>},
    {"conformance.types.Sample[3-]", codec<::rr::BoundedArray<Sample, 3>>},
    {"conformance.types.Sample[]", codec<::rr::Array<Sample>>},
    {"conformance.types.Sample[]{list}", codec<std::optional<std::vector<::rr::Array<Sample>>>>},
    {"conformance.types.Sample{int32}", codec<std::optional<std::map<std::int32_t, Sample>>>},
    {"conformance.types.Sample{list}", codec<std::optional<std::vector<Sample>>>},
    {"conformance.types.Stats", codec<std::optional<Stats>>},
    {"conformance.types.Stats{int32}",
     codec<std::optional<std::map<std::int32_t, std::optional<Stats>>>>},
    {"conformance.types.Stats{list}", codec<std::optional<std::vector<std::optional<Stats>>>>},
    {"conformance.types.Stats{string}",
     codec<std::optional<std::map<std::string, std::optional<Stats>>>>},
    {"conformance.types.Ticks", codec<Ticks>},
    {"conformance.types.Transform", codec<Transform>},
    {"conformance.types.Transform[]", codec<::rr::Array<Transform>>},
    {"conformance.types.Tree", codec<std::optional<Tree>>},
    {"conformance.types.Twist", codec<Twist>},
    {"conformance.types.Vector3", codec<Vector3>},
    {"conformance.types.Vector3[*]", codec<::rr::MultiArray<Vector3>>},
    {"conformance.types.Vector3[2]", codec<std::array<Vector3, 2>>},
    {"conformance.types.Vector3[]", codec<::rr::Array<Vector3>>},
    {"conformance.types.Vector3{list}", codec<std::optional<std::vector<Vector3>>>},
    {"csingle", codec<std::complex<float>>},
    {"csingle[]", codec<::rr::Array<std::complex<float>>>},
    {"double", codec<double>},
    {"double[*]", codec<::rr::MultiArray<double>>},
    {"double[*]{list}", codec<std::optional<std::vector<::rr::MultiArray<double>>>>},
    {"double[3]", codec<std::array<double, 3>>},
    {"double[4]", codec<std::array<double, 4>>},
    {"double[]", codec<::rr::Array<double>>},
    {"double{int32}", codec<std::optional<std::map<std::int32_t, double>>>},
    {"double{list}", codec<std::optional<std::vector<double>>>},
    {"double{string}", codec<std::optional<std::map<std::string, double>>>},
    {"int16", codec<std::int16_t>},
    {"int16[5-]", codec<::rr::BoundedArray<std::int16_t, 5>>},
    {"int16[]", codec<::rr::Array<std::int16_t>>},
    {"int32", codec<std::int32_t>},
    {"int32[*]", codec<::rr::MultiArray<std::int32_t>>},
    {"int32[]", codec<::rr::Array<std::int32_t>>},
    {"int32[]{list}", codec<std::optional<std::vector<::rr::Array<std::int32_t>>>>},
    {"int32{int32}", codec<std::optional<std::map<std::int32_t, std::int32_t>>>},
    {"int32{list}", codec<std::optional<std::vector<std::int32_t>>>},
    {"int32{string}", codec<std::optional<std::map<std::string, std::int32_t>>>},
    {"int64", codec<std::int64_t>},
    {"int64[*]", codec<::rr::MultiArray<std::int64_t>>},
    {"int64[]", codec<::rr::Array<std::int64_t>>},
    {"int8", codec<std::int8_t>},
    {"int8[]", codec<::rr::Array<std::int8_t>>},
    {"single", codec<float>},
    {"single[3,2]", codec<::rr::FixedMultiArray<float, 3, 2>>},
    {"single[]", codec<::rr::Array<float>>},
    {"string", codec<std::string>},
    {"string{int32}", codec<std::optional<std::map<std::int32_t, std::string>>>},
    {"string{list}", codec<std::optional<std::vector<std::string>>>},
    {"string{string}", codec<std::optional<std::map<std::string, std::string>>>},
    {"uint16", codec<std::uint16_t>},
    {"uint16[]", codec<::rr::Array<std::uint16_t>>},
    {"uint32", codec<std::uint32_t>},
    {"uint32[]", codec<::rr::Array<std::uint32_t>>},
    {"uint64", codec<std::uint64_t>},
    {"uint64[]", codec<::rr::Array<std::uint64_t>>},
    {"uint8", codec<std::uint8_t>},
    {"uint8[*]", codec<::rr::MultiArray<std::uint8_t>>},
    {"uint8[]", codec<::rr::Array<std::uint8_t>>},
    {"uint8[]{string}", codec<std::optional<std::map<std::string, ::rr::Array<std::uint8_t>>>>},
    {"uint8{list}", codec<std::optional<std::vector<std::uint8_t>>>},
    {"varvalue", codec<::rr::VarValue>},
    {"varvalue{int32}", codec<std::optional<std::map<std::int32_t, ::rr::VarValue>>>},
    {"varvalue{list}", codec<std::optional<std::vector<::rr::VarValue>>>},
    {"varvalue{string}", codec<std::optional<std::map<std::string, ::rr::VarValue>>>},
};

}  // namespace

const CaptureCodec& capture_codec(std::string_view robdef_type) { return codecs.at(robdef_type); }

void from_capture(const json& from, ::rr::VarValue& to) {
  to = from.is_null()
           ? ::rr::VarValue()
           : capture_codec(from.at("type").get<std::string>()).make_varvalue(from.at("value"));
}

}  // namespace conformance::types
