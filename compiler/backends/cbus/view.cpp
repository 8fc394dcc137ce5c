// SPDX-License-Identifier: Apache-2.0
// Model -> view. Reports R0901 (names), R0903 (reserved words) and R0930 (what is no bus).
#include "compiler/backends/cbus/view.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <set>

#include "compiler/backends/cbus/layout.hpp"
#include "compiler/backends/cbus/names.hpp"
#include "compiler/backends/name_set.hpp"
#include "compiler/output/prose.hpp"

namespace robdef::cbus {
namespace {

using model::Primitive;
using model::Record;

struct NumberRow {
  Primitive primitive;
  const char* type;  // in C
  const char* word;  // rr_bus_put_..., RR_BUS_...
  const char* constant;
  const char* simulink;
};
constexpr std::array number_rows{
    NumberRow{Primitive::double_, "double", "double", "RR_BUS_DOUBLE", "double"},
    NumberRow{Primitive::single, "float", "single", "RR_BUS_SINGLE", "single"},
    NumberRow{Primitive::int8, "int8_t", "int8", "RR_BUS_INT8", "int8"},
    NumberRow{Primitive::uint8, "uint8_t", "uint8", "RR_BUS_UINT8", "uint8"},
    NumberRow{Primitive::int16, "int16_t", "int16", "RR_BUS_INT16", "int16"},
    NumberRow{Primitive::uint16, "uint16_t", "uint16", "RR_BUS_UINT16", "uint16"},
    NumberRow{Primitive::int32, "int32_t", "int32", "RR_BUS_INT32", "int32"},
    NumberRow{Primitive::uint32, "uint32_t", "uint32", "RR_BUS_UINT32", "uint32"},
    NumberRow{Primitive::int64, "int64_t", "int64", "RR_BUS_INT64", "int64"},
    NumberRow{Primitive::uint64, "uint64_t", "uint64", "RR_BUS_UINT64", "uint64"},
    NumberRow{Primitive::cdouble, "rr_bus_cdouble", "cdouble", "RR_BUS_CDOUBLE", "double"},
    NumberRow{Primitive::csingle, "rr_bus_csingle", "csingle", "RR_BUS_CSINGLE", "single"},
    NumberRow{Primitive::bool_, "uint8_t", "bool", "RR_BUS_BOOL", "boolean"}};

// What lay_out() and the checks before have left: numbers of these types only.
const NumberRow& row_of(Primitive primitive) {
  return *std::ranges::find(number_rows, primitive, &NumberRow::primitive);
}

std::string gap_member(std::size_t number, std::uint64_t bytes) {
  if (bytes == 0) return "";
  return "uint8_t rr_gap_" + std::to_string(number) + "[" + std::to_string(bytes) + "];";
}

std::string dimensions_text(const model::Type& type) {
  if (type.array == model::ArrayForm::none) return "1";
  std::string text;
  for (const std::uint32_t dimension : type.dimensions) {
    text += (text.empty() ? "" : " ") + std::to_string(dimension);
  }
  return type.dimensions.size() == 1 ? text : "[" + text + "]";
}

std::vector<std::string> comment(const std::string& documentation) {
  std::vector<std::string> lines = prose(documentation, " * ", 90);
  // The text may not end the comment that it stands in.
  for (std::string& line : lines) {
    for (std::size_t at = line.find("*/"); at != std::string::npos; at = line.find("*/")) {
      line.replace(at, 2, "* /");
    }
  }
  return lines;
}

FieldView make_field(const PlacedField& placed, std::size_t number, const std::string& record,
                     Report& report) {
  const model::Field& field = *placed.field;
  const bool is_array = field.type.array != model::ArrayForm::none;
  FieldView view;
  view.wire_name = field.name;
  view.name = field_name(code_name(field), field.span, report);
  view.doc = comment(field.documentation);
  view.gap = gap_member(number, placed.gap);
  view.offset = std::to_string(placed.offset.eight);
  view.offset_four = std::to_string(placed.offset.four);
  view.claim = record + "_at_" + code_name(field);
  view.count = std::to_string(placed.count);
  view.address = is_array ? "" : "&";
  if (is_array) view.dimension = "[" + view.count + "]";
  view.simulink_dimensions = dimensions_text(field.type);
  view.complexity = "real";
  if (const auto* const inner = std::get_if<const Record*>(&field.type.base)) {
    view.type = type_name(**inner);
    view.put = view.type + "_put";
    view.get = view.type + "_get";
    view.simulink_type = "Bus: " + view.type;
  } else {
    const Primitive primitive = std::get<Primitive>(field.type.base);
    const NumberRow& row = row_of(primitive);
    view.type = row.type;
    view.put = std::string("rr_bus_put_") + row.word;
    view.get = std::string("rr_bus_get_") + row.word;
    view.simulink_type = row.simulink;
    if (primitive == Primitive::cdouble || primitive == Primitive::csingle) {
      view.complexity = "complex";
    }
  }
  return view;
}

std::string name_in_c(const model::Field& field) {
  Report silent;  // the field itself has been reported
  return field_name(code_name(field), field.span, silent);
}

void add_signals(const Record& record, RecordView& view) {
  const std::vector<Signal> signals = signals_of(record, &name_in_c);
  std::array<char, 24> hash{};
  std::snprintf(hash.data(), hash.size(), "0x%016llX",
                static_cast<unsigned long long>(hash_of(record, signals)));
  view.hash = hash.data();
  view.signal_count = std::to_string(signals.size());
  for (const Signal& signal : signals) {
    view.signals.push_back({.name = signal.name,
                            .path = signal.path,
                            .type = row_of(signal.type).constant,
                            .count = std::to_string(signal.count),
                            .place = std::to_string(signal.place)});
  }
}

RecordView make_record(const Record& record, Report& report) {
  const RecordLayout layout = layout_of(record);
  RecordView view;
  view.wire_name = record.qualified_name();
  view.c_name = type_name(record);
  view.doc = comment(record.documentation);
  view.is_bus = record.kind == model::RecordKind::pod;
  NameSet names(cbus_language, report);
  for (const PlacedField& placed : layout.fields) {
    view.fields.push_back(make_field(placed, view.fields.size(), view.c_name, report));
    names.add(view.fields.back().name, placed.field->span, "field",
              record.qualified_name() + "." + placed.field->name);
  }
  view.gap = gap_member(view.fields.size(), layout.gap_at_end);
  view.size = std::to_string(layout.size.eight);
  view.size_four = std::to_string(layout.size.four);
  view.bytes = std::to_string(layout.packed);
  view.frame_bytes = std::to_string(layout.packed + 44);
  if (view.is_bus) add_signals(record, view);
  return view;
}

/// A definition's records, each behind those that it contains.
class Order {
 public:
  explicit Order(const model::Definition& definition) : definition_(definition) {
    for (const Record& record : definition.records) {
      if (record.kind != model::RecordKind::struct_) add(record);
    }
  }
  [[nodiscard]] const std::vector<const Record*>& records() const { return records_; }
  /// Definitions of contained records that are not this one's.
  [[nodiscard]] const std::set<std::string>& others() const { return others_; }

 private:
  void add(const Record& record) {
    if (record.definition != &definition_) {
      others_.insert(record.definition->name);
      return;
    }
    if (std::ranges::find(records_, &record) != records_.end()) return;
    for (const Record* const inner : inner_records(record)) add(*inner);
    records_.push_back(&record);
  }

  const model::Definition& definition_;
  std::vector<const Record*> records_;
  std::set<std::string> others_;
};

bool check(const Order& order, TypeNames& names, Report& report) {
  Report findings;
  for (const Record* const record : order.records()) {
    names.add(*record);
    check_record(*record, report);
    check_record(*record, findings);
    // Of an import nothing is generated here, and so nothing has been reported.
    for (const Record* const inner : inner_records(*record)) {
      if (inner->definition == record->definition) continue;
      check_record(*inner, report);
      check_record(*inner, findings);
    }
  }
  return !findings.has_errors();
}

}  // namespace

ModelView make_view(const model::Model& model, Report& report) {
  ModelView view;
  TypeNames names(report);
  Span first;
  bool has_definition = false;
  for (const auto& definition : model.definitions()) {
    if (definition->is_import) continue;
    if (!has_definition) first = definition->span;
    has_definition = true;
    const Order order(*definition);
    if (order.records().empty()) continue;
    names.add_definition(*definition);
    if (!check(order, names, report)) continue;
    DefinitionView& made = view.definitions.emplace_back();
    made.wire_name = definition->name;
    made.prefix = prefix_of(definition->name);
    made.guard = guard_of(definition->name);
    made.doc = comment(definition->documentation);
    for (const std::string& other : order.others()) {
      made.includes.push_back(prefix_of(other) + "_bus.h");
      made.others.push_back(prefix_of(other) + "_buses");
    }
    for (const Record* const record : order.records()) {
      made.records.push_back(make_record(*record, report));
    }
  }
  if (has_definition && view.definitions.empty() && !report.has_errors()) {
    report.add(Code::R0930, first, "nothing here can be a bus")
        .label("has no pod")
        .help("a bus is a pod: numbers, arrays of them with a length, and other pods");
  }
  return view;
}

}  // namespace robdef::cbus
