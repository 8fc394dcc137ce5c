// SPDX-License-Identifier: Apache-2.0
// What the codec costs a call: a property's request and answer, the fields of a structure, a list.
#include <benchmark/benchmark.h>

#include <array>
#include <vector>

#include "rr/message_tree.hpp"
#include "rr/reader.hpp"

namespace rr {
namespace {

MessageVersion version_of(const benchmark::State& state) {
  return state.range(0) == 2 ? MessageVersion::v2 : MessageVersion::v4;
}

void write_double(Writer& writer, const ElementName& name, double value) {
  const std::size_t end = writer.position();
  writer.prepend_bytes(&value, sizeof value);
  writer.element(name, ElementType::double_, {}, 1, end);
}

void write_property(Writer& writer, MessageVersion version, EntryType type, bool with_value) {
  writer.reset(version);
  if (with_value) write_double(writer, "value", 1.5);
  EntryHeader entry;
  entry.type = type;
  entry.service_path = "robot.arm";
  entry.member = "joint_speed";
  entry.request_id = 1234;
  writer.entry(entry, with_value ? 1 : 0, 0);
  MessageHeader header;
  header.sender_endpoint = 0x12345678;
  header.receiver_endpoint = 0x9abcdef0;
  header.message_id = 42;
  header.routing = false;
  writer.message(header, 1);
}

void write_property_get(benchmark::State& state) {
  Writer writer;
  for ([[maybe_unused]] auto _ : state) {
    write_property(writer, version_of(state), EntryType::property_get_req, false);
    benchmark::DoNotOptimize(writer.pieces().data());
  }
}
BENCHMARK(write_property_get)->Arg(2)->Arg(4);

void write_property_value(benchmark::State& state) {
  Writer writer;
  for ([[maybe_unused]] auto _ : state) {
    write_property(writer, version_of(state), EntryType::property_get_res, true);
    benchmark::DoNotOptimize(writer.pieces().data());
  }
}
BENCHMARK(write_property_value)->Arg(2)->Arg(4);

void read_property_value(benchmark::State& state) {
  Writer writer;
  write_property(writer, version_of(state), EntryType::property_get_res, true);
  const std::vector<std::byte> bytes = writer.copy();
  for ([[maybe_unused]] auto _ : state) {
    Message message;
    Entry entry;
    Element element;
    double value = 0;
    if (!read_message(bytes, Limits{}, false, message, nullptr)) state.SkipWithError("refused");
    EntryReader(message).next(entry);
    Decoder decoder(message.version, &message.strings);
    ElementReader(decoder, entry.elements, entry.element_count).next(element);
    std::memcpy(&value, element.payload.data(), sizeof value);
    benchmark::DoNotOptimize(value);
  }
}
BENCHMARK(read_property_value)->Arg(2)->Arg(4);

constexpr std::array<std::string_view, 20> field_names = {
    "position_x", "position_y", "position_z", "velocity_x", "velocity_y", "velocity_z",  "force_x",
    "force_y",    "force_z",    "torque_x",   "torque_y",   "torque_z",   "temperature", "current",
    "voltage",    "power",      "status",     "mode",       "seqno",      "timestamp"};

template <std::size_t... index>
constexpr auto make_prefixes(std::index_sequence<index...>) {
  return std::array{ScalarPrefix(field_names[index], ElementType::double_)...};
}
constexpr auto prefixes = make_prefixes(std::make_index_sequence<field_names.size()>());

std::vector<std::byte> twenty_fields(MessageVersion version) {
  Writer writer;
  writer.reset(version);
  for (std::size_t i = field_names.size(); i-- != 0;) write_double(writer, field_names[i], 1.5);
  return writer.copy();
}

void next_element(benchmark::State& state) {
  const std::vector<std::byte> bytes = twenty_fields(version_of(state));
  for ([[maybe_unused]] auto _ : state) {
    Decoder decoder(version_of(state));
    ElementReader reader(decoder, bytes, field_names.size());
    Element element;
    while (reader.next(element)) benchmark::DoNotOptimize(element);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(field_names.size()));
}
BENCHMARK(next_element)->Arg(2)->Arg(4);

void check_twenty_fields(benchmark::State& state) {
  const std::vector<std::byte> bytes = twenty_fields(version_of(state));
  for ([[maybe_unused]] auto _ : state) {
    Decoder decoder(version_of(state));
    benchmark::DoNotOptimize(check_elements(decoder, bytes, field_names.size(), Limits{}));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(field_names.size()));
}
BENCHMARK(check_twenty_fields)->Arg(2)->Arg(4);

void match_prefix(benchmark::State& state) {
  const std::vector<std::byte> bytes = twenty_fields(MessageVersion::v4);
  for ([[maybe_unused]] auto _ : state) {
    Decoder decoder(MessageVersion::v4);
    ElementReader reader(decoder, bytes, field_names.size());
    double value = 0;
    double sum = 0;
    for (const ScalarPrefix& prefix : prefixes) {
      if (!reader.match(prefix, value)) state.SkipWithError("no match");
      sum += value;
    }
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(field_names.size()));
}
BENCHMARK(match_prefix);

void write_prefix(benchmark::State& state) {
  Writer writer;
  for ([[maybe_unused]] auto _ : state) {
    writer.reset(MessageVersion::v4);
    for (std::size_t i = prefixes.size(); i-- != 0;) writer.prepend_scalar(prefixes[i], 1.5);
    benchmark::DoNotOptimize(writer.position());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(field_names.size()));
}
BENCHMARK(write_prefix);

void write_element(benchmark::State& state) {
  Writer writer;
  for ([[maybe_unused]] auto _ : state) {
    writer.reset(version_of(state));
    for (std::size_t i = field_names.size(); i-- != 0;) write_double(writer, field_names[i], 1.5);
    benchmark::DoNotOptimize(writer.position());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(field_names.size()));
}
BENCHMARK(write_element)->Arg(2)->Arg(4);

void string_table(benchmark::State& state) {
  Writer writer;
  write_property(writer, MessageVersion::v4, EntryType::property_get_res, true);
  const std::vector<std::byte> bytes = writer.copy();
  for ([[maybe_unused]] auto _ : state)
    benchmark::DoNotOptimize(apply_string_table(bytes, true, true));
}
BENCHMARK(string_table);

}  // namespace
}  // namespace rr
