// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/diagnostics/report.hpp"
#include "compiler/model/model.hpp"

/// Where the fields of a record lie in C, and its signals in a frame (docs/howto/realtime.md).
namespace robdef::cbus {

/// Most bytes of a bus in one frame, and most rows of its table.
inline constexpr std::uint64_t largest_payload = 1428;

/// A size or place where a double has 8 bytes and numbers lie at multiples of their size, and where
/// it has 4 and everything lies side by side (AVR). Gaps are members, so they are there too.
struct Bytes {
  std::uint64_t eight = 0;
  std::uint64_t four = 0;
};

struct PlacedField {
  const model::Field* field = nullptr;
  std::uint64_t gap = 0;  ///< bytes before it
  Bytes offset;
  std::uint64_t count = 1;
};

struct RecordLayout {
  std::vector<PlacedField> fields;
  std::uint64_t gap_at_end = 0;
  Bytes size;
  std::uint64_t alignment = 1;
  std::uint64_t packed = 0;  ///< bytes in a frame
};

/// Of a record that check_record() has found nothing in.
RecordLayout layout_of(const model::Record& record);

/// Reports R0930 for what cannot be in a bus.
void check_record(const model::Record& record, Report& report);

/// One run of equal numbers: a row of the table.
struct Signal {
  std::string name;  ///< of the definition: `samples[2].stamp`
  std::string path;  ///< the same with names of C
  model::Primitive type{};
  std::uint64_t count = 1;
  std::uint64_t place = 0;  ///< in the frame
};
/// Of a pod. `field_names` gives the name in C of a field.
std::vector<Signal> signals_of(const model::Record& pod,
                               std::string (*field_name)(const model::Field&));
/// What both ends of a stream compare: the same as rr::realtime::Layout::hash().
std::uint64_t hash_of(const model::Record& pod, const std::vector<Signal>& signals);

/// The records that are fields of this one, each once, in order.
std::vector<const model::Record*> inner_records(const model::Record& record);

}  // namespace robdef::cbus
