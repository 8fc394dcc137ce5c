// SPDX-License-Identifier: Apache-2.0
// Computes the sizes of pods and namedarrays and finds recursive structs. Reads the fields of
// records; fills number, number_count, packed_size, is_recursive.
// Reports R0401-R0405 (V18-V22).
#include "compiler/model/layout.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

#include "compiler/model/graph.hpp"
#include "compiler/model/phrases.hpp"
#include "compiler/model/syntax_errors.hpp"

namespace robdef::model {
namespace {

constexpr std::uint64_t largest = std::numeric_limits<std::uint64_t>::max();

std::uint64_t sum(std::uint64_t a, std::uint64_t b) { return a > largest - b ? largest : a + b; }

std::uint64_t product(std::uint64_t a, std::uint64_t b) {
  return a != 0 && b > largest / a ? largest : a * b;
}

const Record* record_of(const Type& type) {
  const auto* record = std::get_if<const Record*>(&type.base);
  return record == nullptr ? nullptr : *record;
}

bool is_record(const Type& type, RecordKind kind) {
  const Record* record = record_of(type);
  return record != nullptr && record->kind == kind;
}

bool is_number(const Type& type) {
  const auto* primitive = std::get_if<Primitive>(&type.base);
  return primitive != nullptr && is_numeric(*primitive);
}

// What other passes report: an unknown name, a misplaced void or generator (V12-V14).
bool is_reported_elsewhere(const Type& type) {
  return std::holds_alternative<Unknown>(type.base) || type.is_void() ||
         type.container == ContainerForm::generator;
}

bool has_open_length(const Type& type) {
  if (type.array == ArrayForm::any_length || type.array == ArrayForm::any_shape) return true;
  const bool has_one_length =
      type.array == ArrayForm::fixed_length || type.array == ArrayForm::maximum_length;
  return has_one_length && type.dimensions.front() == 0;
}

// Bytes of a message element of format 2 but name, type name and payload (01, section 4).
constexpr std::uint64_t element_overhead = 16;
// The longest decimal index of an array item.
constexpr std::uint64_t longest_index = 10;
constexpr std::string_view namedarray_payload = "array";

// Digits of all indices below `count` together; items of a pod array are named by their index.
std::uint64_t index_digits(std::uint64_t count) {
  std::uint64_t digits = 0;
  std::uint64_t first = 0;
  std::uint64_t end = 10;
  for (std::uint64_t width = 1; first < count && width <= longest_index; ++width) {
    digits = sum(digits, product(std::min(count, end) - first, width));
    first = end;
    end *= 10;
  }
  return digits;
}

class Layout {
 public:
  Layout(Model& model, Report& report) : report_(report), syntax_errors_(report) {
    for (const auto& definition : model.definitions()) {
      for (Record& record : definition->records) {
        number_.emplace(&record, records_.size());
        records_.push_back(&record);
      }
    }
  }

  void run() {
    for (const Record* record : records_) {
      if (record->kind == RecordKind::pod) check_pod(*record);
      if (record->kind == RecordKind::namedarray) check_namedarray(*record);
    }
    report_cycles(RecordKind::pod);
    report_cycles(RecordKind::namedarray);
    mark_recursive_structs();
    compute_sizes();
  }

 private:
  void check_pod(const Record& pod);
  void check_namedarray(const Record& namedarray);
  void report_cycles(RecordKind kind);
  void mark_recursive_structs();
  void compute_sizes();
  void compute_namedarray(Record& namedarray);
  void compute_pod(Record& pod);
  [[nodiscard]] static std::uint64_t packed_size(const Field& field);
  [[nodiscard]] Graph containment(RecordKind kind) const;
  void report_mixed(const Record& namedarray, const Field& first, Primitive expected,
                    const Field& other, Primitive found);

  Report& report_;
  SyntaxErrors syntax_errors_;
  std::vector<Record*> records_;
  std::unordered_map<const Record*, std::size_t> number_;
};

// V18
void Layout::check_pod(const Record& pod) {
  for (const Field& field : pod.fields) {
    const Type& type = field.type;
    if (is_reported_elsewhere(type)) continue;
    if (type.container != ContainerForm::none) {
      report_.add(Code::R0401, type.span, "a pod field in a container")
          .label("has no bounded size")
          .help("use an array with a length, or make " + in_ticks(pod.name) + " a struct");
      continue;
    }
    const bool fits = is_number(type) || is_record(type, RecordKind::pod) ||
                      is_record(type, RecordKind::namedarray);
    if (!fits) {
      report_.add(Code::R0401, type.span, "a pod field that is no number, pod or namedarray")
          .label("cannot be part of a pod")
          .help("make " + in_ticks(pod.name) + " a struct");
      continue;
    }
    if (!has_open_length(type)) continue;
    report_.add(Code::R0401, type.span, "a pod field without a largest length")
        .label("can have any length")
        .help("give the array a length (`[4]`), a largest length (`[4-]`) or dimensions (`[2,2]`)");
  }
}

// V20, and that a namedarray is not empty (V22)
void Layout::check_namedarray(const Record& namedarray) {
  if (namedarray.fields.empty() && !syntax_errors_.any_in(*namedarray.definition)) {
    report_
        .add(Code::R0405, namedarray.span, "namedarray " + in_ticks(namedarray.name) + " is empty")
        .label("has no fields")
        .help("add a field of a number type");
  }
  for (const Field& field : namedarray.fields) {
    const Type& type = field.type;
    if (is_reported_elsewhere(type)) continue;
    if (!is_number(type) && !is_record(type, RecordKind::namedarray)) {
      report_.add(Code::R0403, type.span, "a namedarray field that is no number or namedarray")
          .label("cannot be part of a namedarray")
          .help(is_record(type, RecordKind::pod)
                    ? "make " + in_ticks(namedarray.name) + " a pod"
                    : "make " + in_ticks(namedarray.name) + " a struct");
      continue;
    }
    const bool is_fixed = type.array == ArrayForm::none || type.array == ArrayForm::fixed_length;
    if (is_fixed && type.container == ContainerForm::none) continue;
    report_.add(Code::R0403, type.span, "a namedarray field without a fixed length")
        .label("neither single nor of the form `[n]`")
        .help("give the array a fixed length, for instance `[3]`");
  }
}

// Empty if there is no record of the kind.
Graph Layout::containment(RecordKind kind) const {
  const bool has_any = std::any_of(records_.begin(), records_.end(),
                                   [kind](const Record* record) { return record->kind == kind; });
  if (!has_any) return Graph(0);
  Graph graph(records_.size());
  for (std::size_t i = 0; i < records_.size(); ++i) {
    if (records_[i]->kind != kind) continue;
    const std::vector<Field>& fields = records_[i]->fields;
    for (std::size_t j = 0; j < fields.size(); ++j) {
      if (is_record(fields[j].type, kind)) {
        graph.add_edge(i, number_.at(record_of(fields[j].type)), j);
      }
    }
  }
  return graph;
}

// V19 for pods, V22 for namedarrays
void Layout::report_cycles(RecordKind kind) {
  for (const std::vector<Graph::Edge>& cycle : containment(kind).cycles()) {
    const auto field = [this](const Graph::Edge& edge) -> const Field& {
      return records_[edge.from]->fields[edge.label];
    };
    const Record& record = *records_[cycle.front().from];
    const Code code = kind == RecordKind::pod ? Code::R0402 : Code::R0405;
    Diagnostic& diagnostic =
        report_.add(code, field(cycle.front()).type.span,
                    std::string(name_of(kind)) + ' ' + in_ticks(record.name) + " contains itself");
    diagnostic.label(cycle.size() == 1 ? "the " + std::string(name_of(kind)) + " itself"
                                       : "through this field");
    for (std::size_t i = 1; i < cycle.size(); ++i) {
      diagnostic.also(field(cycle[i]).type.span,
                      "which contains " + in_ticks(records_[cycle[i].to]->name));
    }
    if (kind == RecordKind::pod) diagnostic.help("a struct can contain itself, a pod cannot");
  }
}

void Layout::mark_recursive_structs() {
  const std::vector<bool> is_cyclic = containment(RecordKind::struct_).cyclic();
  for (std::size_t i = 0; i < is_cyclic.size(); ++i) records_[i]->is_recursive = is_cyclic[i];
}

void Layout::compute_sizes() {
  const Graph namedarrays = containment(RecordKind::namedarray);
  const std::vector<bool> is_endless_namedarray = namedarrays.cyclic();
  for (const std::vector<std::size_t>& group : namedarrays.groups()) {
    Record& record = *records_[group.front()];
    const bool is_computed =
        record.kind == RecordKind::namedarray && !is_endless_namedarray[group.front()];
    if (is_computed) compute_namedarray(record);
  }
  const Graph pods = containment(RecordKind::pod);
  const std::vector<bool> is_endless_pod = pods.cyclic();
  for (const std::vector<std::size_t>& group : pods.groups()) {
    Record& record = *records_[group.front()];
    if (record.kind == RecordKind::pod && !is_endless_pod[group.front()]) compute_pod(record);
  }
}

// V21; nested namedarrays come before
void Layout::compute_namedarray(Record& namedarray) {
  const Field* first = nullptr;
  for (const Field& field : namedarray.fields) {
    const auto* primitive = std::get_if<Primitive>(&field.type.base);
    const Record* nested = record_of(field.type);
    const Primitive number = primitive != nullptr ? *primitive
                             : nested != nullptr  ? nested->number
                                                  : Primitive::void_;
    if (!is_numeric(number)) continue;  // reported
    if (first == nullptr) {
      first = &field;
      namedarray.number = number;
    } else if (number != namedarray.number) {
      report_mixed(namedarray, *first, namedarray.number, field, number);
      continue;
    }
    const std::uint64_t each = nested == nullptr ? 1 : nested->number_count;
    namedarray.number_count =
        sum(namedarray.number_count, product(field.type.element_count(), each));
  }
}

void Layout::report_mixed(const Record& namedarray, const Field& first, Primitive expected,
                          const Field& other, Primitive found) {
  report_
      .add(Code::R0404, other.type.span,
           "namedarray " + in_ticks(namedarray.name) + " has more than one number type")
      .label("is of " + in_ticks(name_of(found)))
      .also(first.type.span, "is of " + in_ticks(name_of(expected)))
      .help("give all fields one type, or make it a pod");
}

void Layout::compute_pod(Record& pod) {
  pod.packed_size = element_overhead + longest_index;
  for (const Field& field : pod.fields) {
    pod.packed_size = sum(pod.packed_size, packed_size(field));
  }
}

// A field of a pod as a nested element (03, section 9).
std::uint64_t Layout::packed_size(const Field& field) {
  const std::uint64_t count = field.type.element_count();
  const std::uint64_t header = element_overhead + field.name.size();
  if (const auto* primitive = std::get_if<Primitive>(&field.type.base)) {
    return sum(header, product(count, size_of(*primitive)));
  }
  const Record* record = record_of(field.type);
  if (record == nullptr) return 0;  // reported
  const std::uint64_t named_header = header + record->qualified_name().size();
  if (record->kind == RecordKind::namedarray) {
    const std::uint64_t numbers = product(count, record->number_count);
    return sum(named_header + element_overhead + namedarray_payload.size(),
               product(numbers, size_of(record->number)));
  }
  if (record->packed_size == 0) return 0;  // contains itself, reported
  const std::uint64_t items = product(count, record->packed_size - longest_index);
  return sum(named_header, sum(items, index_digits(count)));
}

}  // namespace

void lay_out(Model& model, Report& report) { Layout(model, report).run(); }

}  // namespace robdef::model
