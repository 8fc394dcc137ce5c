// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/cbus/layout.hpp"

#include <algorithm>
#include <variant>

namespace robdef::cbus {
namespace {

using model::Primitive;

const model::Record* record_of(const model::Type& type) {
  const auto* const record = std::get_if<const model::Record*>(&type.base);
  return record == nullptr ? nullptr : *record;
}

Primitive primitive_of(const model::Type& type) {
  const auto* const primitive = std::get_if<Primitive>(&type.base);
  return primitive == nullptr ? Primitive::void_ : *primitive;
}

bool is_complex(Primitive type) { return type == Primitive::cdouble || type == Primitive::csingle; }

RecordLayout number_layout(Primitive type) {
  const std::uint64_t size = model::size_of(type);
  RecordLayout layout;
  layout.alignment = is_complex(type) ? size / 2 : size;
  layout.packed = size;
  layout.size.eight = size;
  const bool is_double = type == Primitive::double_ || type == Primitive::cdouble;
  layout.size.four = is_double ? size / 2 : size;
  return layout;
}

RecordLayout item_layout(const model::Type& type) {
  const model::Record* const record = record_of(type);
  return record == nullptr ? number_layout(primitive_of(type)) : layout_of(*record);
}

std::uint64_t gap_before(std::uint64_t place, std::uint64_t alignment) {
  return (alignment - place % alignment) % alignment;
}

class SignalWriter {
 public:
  explicit SignalWriter(std::string (*field_name)(const model::Field&)) : field_name_(field_name) {}

  void add(const model::Record& pod, const std::string& name, const std::string& path) {
    for (const model::Field& field : pod.fields) {
      const std::string inner_name = name + field.name;
      const std::string inner_path = path + field_name_(field);
      const model::Record* const record = record_of(field.type);
      const std::uint64_t count = field.type.element_count();
      if (record == nullptr) {
        add_run(inner_name, inner_path, primitive_of(field.type), count);
      } else if (record->kind == model::RecordKind::namedarray) {
        add_run(inner_name, inner_path, record->number, count * record->number_count);
      } else if (field.type.array == model::ArrayForm::none) {
        add(*record, inner_name + ".", inner_path + ".");
      } else {
        for (std::uint64_t i = 0; i < count; ++i) {
          const std::string index = "[" + std::to_string(i) + "].";
          add(*record, inner_name + index, inner_path + index);
        }
      }
    }
  }
  std::vector<Signal> take() { return std::move(signals_); }

 private:
  void add_run(const std::string& name, const std::string& path, Primitive type,
               std::uint64_t count) {
    signals_.push_back({.name = name, .path = path, .type = type, .count = count, .place = place_});
    place_ += count * model::size_of(type);
  }

  std::string (*field_name_)(const model::Field&);
  std::uint64_t place_ = 0;
  std::vector<Signal> signals_;
};

}  // namespace

RecordLayout layout_of(const model::Record& record) {
  RecordLayout layout;
  for (const model::Field& field : record.fields) {
    const RecordLayout item = item_layout(field.type);
    PlacedField placed;
    placed.field = &field;
    placed.count = field.type.element_count();
    placed.gap = gap_before(layout.size.eight, item.alignment);
    placed.offset = {layout.size.eight + placed.gap, layout.size.four + placed.gap};
    layout.size = {placed.offset.eight + placed.count * item.size.eight,
                   placed.offset.four + placed.count * item.size.four};
    layout.packed += placed.count * item.packed;
    layout.alignment = std::max(layout.alignment, item.alignment);
    layout.fields.push_back(placed);
  }
  layout.gap_at_end = gap_before(layout.size.eight, layout.alignment);
  layout.size.eight += layout.gap_at_end;
  layout.size.four += layout.gap_at_end;
  return layout;
}

void check_record(const model::Record& record, Report& report) {
  bool is_sound = true;
  const auto refuse = [&](Span span, const std::string& what, const std::string& label,
                          const std::string& help) {
    is_sound = false;
    report.add(Code::R0930, span, what).label(label).help(help);
  };
  for (const model::Field& field : record.fields) {
    const model::Type& type = field.type;
    if (type.array == model::ArrayForm::maximum_length) {
      refuse(type.span, "a field of a bus without a fixed length", "may have fewer items",
             "give it a length, and a field that says how many of them count");
    } else if (type.element_count() > largest_payload) {
      refuse(type.span, "a field of a bus that does not fit a frame", "has too many items",
             "a frame holds 1428 bytes; offer larger things as members of an object");
    }
  }
  if (record.kind != model::RecordKind::pod) return;
  if (record.fields.empty()) {
    refuse(record.span, "a bus without signals", "has no fields", "add a field");
  }
  // Inner records are reported by themselves, and have no layout to be added up then.
  for (const model::Record* const inner : inner_records(record)) {
    Report silent;
    check_record(*inner, silent);
    is_sound = is_sound && !silent.has_errors();
  }
  if (!is_sound) return;
  const std::uint64_t bytes = layout_of(record).packed;
  if (bytes <= largest_payload) return;
  refuse(record.span, "a bus of " + std::to_string(bytes) + " bytes", "does not fit a frame",
         "a frame holds 1428 bytes; make two buses of it");
}

std::vector<Signal> signals_of(const model::Record& pod,
                               std::string (*field_name)(const model::Field&)) {
  SignalWriter writer(field_name);
  writer.add(pod, "", "");
  return writer.take();
}

std::uint64_t hash_of(const model::Record& pod, const std::vector<Signal>& signals) {
  std::string text = pod.qualified_name() + "\n";
  for (const Signal& signal : signals) {
    text += signal.name + ' ' + std::string(model::name_of(signal.type)) + ' ' +
            std::to_string(signal.count) + '\n';
  }
  std::uint64_t hash = 0xCBF29CE484222325U;  // FNV-1a
  for (const char letter : text) {
    hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001B3U;
  }
  return hash;
}

std::vector<const model::Record*> inner_records(const model::Record& record) {
  std::vector<const model::Record*> records;
  for (const model::Field& field : record.fields) {
    const model::Record* const inner = record_of(field.type);
    if (inner != nullptr && std::ranges::find(records, inner) == records.end()) {
      records.push_back(inner);
    }
  }
  return records;
}

}  // namespace robdef::cbus
