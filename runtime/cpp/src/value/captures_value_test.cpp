// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "rr/registry.hpp"
#include "runtime/cpp/src/codec/captures.hpp"
#include "runtime/cpp/src/value/capture_codec.hpp"
#include "runtime/cpp/src/value/conformance_types.hpp"

// The recorded single values: each is packed from its type and value alone, and unpacked and packed
// again, to the recorded bytes.
namespace rr {
namespace {

using conformance::types::capture_codec;
using nlohmann::json;

struct Recorded {
  json description;
  std::vector<std::byte> bytes;
};

std::vector<Recorded> recorded(MessageVersion version) {
  const std::string file = version == MessageVersion::v2 ? "/values-v2.json" : "/values-v4.json";
  std::ifstream stream(RR_CAPTURES_DIR + file);
  const json values = json::parse(stream).at("values");
  const std::vector<captures::Value> bytes = captures::values(version);
  std::vector<Recorded> result;
  for (const json& value : values) {
    if (value.contains("refused")) continue;
    const std::string name = value.at("name");
    const auto same = [&](const captures::Value& one) { return one.name == name; };
    const auto found = std::find_if(bytes.begin(), bytes.end(), same);
    if (found == bytes.end()) throw std::runtime_error("no bytes for " + value.dump());
    result.push_back({value, found->bytes});
  }
  return result;
}

// Keeps the text alive that the name refers to.
struct RecordedName {
  explicit RecordedName(const json& value)
      : text(value.contains("element_name") ? name_of(value.at("element_name")) : ""),
        name(value.contains("element_name")
                 ? ElementName(std::string_view(text))
                 : ElementName(value.at("element_number").get<std::int32_t>())) {}

  static std::string name_of(const json& name) {
    if (!name.is_object()) return name;
    return std::string(name.at("count").get<std::size_t>(),
                       name.at("repeat").get<std::string>().at(0));
  }

  std::string text;
  ElementName name;
};

class RecordedValues : public testing::TestWithParam<MessageVersion> {};

// What typed values do not have.
bool has_metadata(const json& value) {
  return value.contains("metadata") || value.contains("extended");
}

TEST_P(RecordedValues, ArePackedFromTypeAndValueAlone) {
  int packed = 0;
  Writer writer;
  for (const Recorded& value : recorded(GetParam())) {
    const json& description = value.description;
    if (has_metadata(description)) continue;
    SCOPED_TRACE(description.at("name"));
    const RecordedName name(description);
    writer.reset(GetParam());
    if (description.at("robdef_type") == "void") {
      writer.null_element(name.name);
    } else {
      capture_codec(description.at("robdef_type").get<std::string>())
          .pack(description.at("value"), name.name, writer);
    }
    ASSERT_FALSE(writer.failed()) << writer.message();
    ASSERT_EQ(writer.copy(), value.bytes);
    ++packed;
  }
  EXPECT_GT(packed, 245);
}

TEST_P(RecordedValues, AreUnpackedAndPackedAgain) {
  int unpacked = 0;
  Writer writer;
  const TypeRegistry types(conformance::types::rr_definition);
  for (const Recorded& value : recorded(GetParam())) {
    const json& description = value.description;
    if (has_metadata(description) || description.at("robdef_type") == "void") continue;
    SCOPED_TRACE(description.at("name"));
    const RecordedName name(description);
    Decoder decoder(GetParam(), nullptr, {}, &types);
    ElementReader reader(decoder, value.bytes, 1);
    Element element;
    ASSERT_TRUE(reader.next(element)) << decoder.message();
    writer.reset(GetParam());
    capture_codec(description.at("robdef_type").get<std::string>())
        .repack(decoder, element, name.name, writer);
    ASSERT_FALSE(decoder.failed()) << decoder.message();
    ASSERT_FALSE(writer.failed()) << writer.message();
    ASSERT_EQ(writer.copy(), value.bytes);
    ++unpacked;
  }
  EXPECT_GT(unpacked, 245);
}

// Every prefix, and every byte changed in turn, fails cleanly or is a value.
TEST_P(RecordedValues, BrokenOnesFailCleanly) {
  const TypeRegistry types(conformance::types::rr_definition);
  Writer writer;
  for (const Recorded& value : recorded(GetParam())) {
    const json& description = value.description;
    if (description.at("robdef_type") == "void" || value.bytes.size() > 4000) continue;
    const auto& codec = capture_codec(description.at("robdef_type").get<std::string>());
    const auto read = [&](std::span<const std::byte> bytes) {
      Decoder decoder(GetParam(), nullptr, {}, &types);
      ElementReader reader(decoder, bytes, 1);
      Element element;
      writer.reset(GetParam());
      if (reader.next(element)) codec.repack(decoder, element, "value", writer);
      return !decoder.failed();
    };
    for (std::size_t size = 0; size < value.bytes.size(); ++size) {
      EXPECT_FALSE(read(std::span(value.bytes).first(size))) << description.at("name");
    }
    std::vector<std::byte> changed = value.bytes;
    for (std::byte& byte : changed) {
      const std::byte before = byte;
      for (const unsigned flip : {0x01U, 0x80U, 0xFFU}) {
        byte = before ^ static_cast<std::byte>(flip);
        read(changed);
      }
      byte = before;
    }
    EXPECT_TRUE(read(changed)) << description.at("name");
  }
}

// The types of the properties that the recorded bad requests set
// (robdef/conformance.service.robdef).
const std::map<std::string_view, std::string_view> properties = {
    {"a_double", "double[]"},
    {"any", "varvalue"},
    {"f_double", "double[3]"},
    {"g_single", "single[3,2]"},
    {"i_double", "double{int32}"},
    {"l_double", "double{list}"},
    {"m_double", "double[*]"},
    {"n_one", "conformance.types.Vector3"},
    {"p_fixed", "conformance.types.Sample[2]"},
    {"p_one", "conformance.types.Sample"},
    {"s_double", "double{string}"},
    {"t_stats", "conformance.types.Stats"},
    {"v_bool", "bool"},
    {"v_double", "double"},
    {"v_int32", "int32"},
    {"v_mode", "conformance.types.Mode"},
    {"v_string", "string"},
};

// What reading the `value` of a request to set a property ends with.
ErrorCode error_of_set(const captures::Frame& frame, const TypeRegistry& types) {
  Message message;
  EXPECT_TRUE(read_message(frame.bytes, Limits{}, false, message, nullptr));
  EntryReader entries(message);
  Entry entry;
  EXPECT_TRUE(entries.next(entry));
  Decoder decoder(message.version, &message.strings, {}, &types);
  Element element;
  if (!find_element(decoder, entry.elements, entry.element_count, "value", element)) {
    return ErrorCode::message_element_not_found;
  }
  Writer writer;
  writer.reset(message.version);
  capture_codec(properties.at(entry.member)).repack(decoder, element, "value", writer);
  return decoder.code();
}

// The recorded code, but for two answers that are not copied.
int expected_code(const json& request, const json& answer) {
  constexpr int data_type_error = 12;
  const int recorded = answer.value("error", 0);
  // An exception of the reference's host language for a wrong count in a pod (03, section 9).
  if (recorded == 100) return data_type_error;
  // Three numbers for dims of two by two are taken (03, section 5).
  for (const json& value : request.at("elements")) {
    if (value.at("type") != 117 || value.at("count") != 2) continue;
    const json& dims = value.at("elements").at(0);
    const json& array = value.at("elements").at(1);
    if (dims.value("value", json()) == json{2, 2} && array.at("count") == 3) {
      return data_type_error;
    }
  }
  return recorded;
}

TEST_P(RecordedValues, BadOnesAreAnsweredWithTheRecordedCodes) {
  const TypeRegistry types(conformance::types::rr_definition);
  const auto frames = captures::frames(GetParam() == MessageVersion::v2 ? "bad_requests.v2.json"
                                                                        : "bad_requests.v4.json");
  constexpr int set_request = 1113;
  constexpr int set_answer = 1114;
  int compared = 0;
  for (std::size_t i = 0; i + 1 < frames.size(); ++i) {
    const json& request = frames[i].decoded.at("entries").at(0);
    const json& answer = frames[i + 1].decoded.at("entries").at(0);
    if (request.at("entry_type") != set_request || answer.at("entry_type") != set_answer) continue;
    if (!properties.contains(request.at("member").get<std::string>())) continue;
    SCOPED_TRACE(frames[i].name);
    EXPECT_EQ(static_cast<int>(error_of_set(frames[i], types)), expected_code(request, answer));
    ++compared;
  }
  EXPECT_GT(compared, 30);
}

INSTANTIATE_TEST_SUITE_P(Versions, RecordedValues,
                         testing::Values(MessageVersion::v2, MessageVersion::v4),
                         [](const testing::TestParamInfo<MessageVersion>& version) {
                           return version.param == MessageVersion::v2 ? "v2" : "v4";
                         });

}  // namespace
}  // namespace rr
