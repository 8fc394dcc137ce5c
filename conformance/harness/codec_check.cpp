// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/codec_check.hpp"

#include "conformance/harness/explanation.hpp"
#include "conformance/harness/values.hpp"

namespace rr::conformance {
namespace {

Result begin(const Scenario& scenario, Role role) {
  Result result;
  result.run = {scenario.name, scenario.version, role};
  return result;
}

Result begin_values(int message_version, Role role) {
  Result result;
  result.run = {"values", "v" + std::to_string(message_version), role};
  return result;
}

Json element_request(const Value& value) {
  return {{"do", "element"},
          {"message_version", value.message_version},
          {"type", value.type},
          {"hex", hex_of_bytes(*value.bytes)}};
}

// What a runner has made.
std::string difference_of(const Bytes& recorded, const Json& answer) {
  return describe_bytes(recorded, bytes_of_hex(answer.get<std::string>()));
}

// A frame that contradicts itself says nothing about who reads or writes it.
std::string explain(const Frame& frame, std::string fault) {
  return contradiction(frame).value_or(std::move(fault));
}

void check_one_packing(const Value& value, Runner& decoder, Runner& encoder, Result& result) {
  const std::string place = case_place(value.name);
  Json request = {{"do", "value"},
                  {"message_version", value.message_version},
                  {"type", value.type},
                  {"value", value.value}};
  request.update(value.element);
  const Json packed = encoder.ask(request);
  if (!value.bytes) {
    if (packed.contains("refused")) {
      ++result.refused;
    } else {
      result.fail(place, value.type,
                  "packed, though the recorded library refuses: " + said(packed, 200));
    }
    return;
  }
  ++result.checked;
  if (!packed.contains("hex"))
    return result.fail(place, value.type, "not packed: " + said(packed, 200));
  if (packed["hex"] != hex_of_bytes(*value.bytes)) {
    return result.fail(place, value.type, difference_of(*value.bytes, packed["hex"]));
  }
  const Json decoded = decoder.ask(element_request(value));
  if (!decoded.contains("decoded")) {
    return result.fail(place, value.type, "not decoded: " + said(decoded, 200));
  }
  const Json again = encoder.ask({{"do", "element"},
                                  {"message_version", value.message_version},
                                  {"decoded", decoded["decoded"]}});
  if (again.value("hex", "") != hex_of_bytes(*value.bytes)) {
    result.fail(place, value.type, "its decode gives other bytes: " + said(again, 200));
  }
}

}  // namespace

Result check_decoding(const Scenario& scenario, Runner& decoder) {
  Result result = begin(scenario, Role::decode);
  for (const Frame& frame : scenario.frames) {
    const Json answer = decoder.ask({{"do", "message"}, {"hex", hex_of_bytes(frame.bytes)}});
    ++result.checked;
    if (!answer.contains("decoded")) {
      result.fail(frame_place(frame.number), "", "not decoded: " + said(answer, 200));
    } else if (answer["decoded"] != frame.decoded) {
      result.fail(frame_place(frame.number), "",
                  explain(frame, describe_difference(frame.decoded, answer["decoded"])));
    }
  }
  return result;
}

Result check_encoding(const Scenario& scenario, Runner& encoder) {
  Result result = begin(scenario, Role::encode);
  for (const Frame& frame : scenario.frames) {
    const Json answer = encoder.ask({{"do", "message"}, {"decoded", frame.decoded}});
    ++result.checked;
    if (!answer.contains("hex")) {
      result.fail(frame_place(frame.number), "", "not encoded: " + said(answer, 200));
    } else if (answer["hex"] != hex_of_bytes(frame.bytes)) {
      result.fail(frame_place(frame.number), "",
                  explain(frame, difference_of(frame.bytes, answer["hex"])));
    }
  }
  return result;
}

Result check_unpacking(const Captures& captures, int message_version, Runner& decoder) {
  Result result = begin_values(message_version, Role::decode);
  for (const Value& value : captures.values) {
    if (value.message_version != message_version || !value.bytes) continue;
    ++result.checked;
    const Json answer = decoder.ask(element_request(value));
    if (!answer.contains("value")) {
      result.fail(case_place(value.name), value.type, "not unpacked: " + said(answer, 200));
    } else if (!same_value(value.value, answer["value"])) {
      result.fail(
          case_place(value.name), value.type,
          said(value.value, 200) + " recorded, " + said(answer["value"], 200) + " unpacked");
    }
  }
  return result;
}

Result check_packing(const Captures& captures, int message_version, Runner& decoder,
                     Runner& encoder) {
  Result result = begin_values(message_version, Role::encode);
  for (const Value& value : captures.values) {
    if (value.message_version != message_version) continue;
    check_one_packing(value, decoder, encoder, result);
  }
  return result;
}

}  // namespace rr::conformance
