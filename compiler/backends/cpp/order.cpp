// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/cpp/order.hpp"

#include <unordered_set>
#include <variant>

#include "compiler/backends/cpp/types.hpp"

namespace robdef::cpp {
namespace {

using model::Declaration;
using model::Definition;
using model::Object;
using model::Record;

/// The types that a member names, its result and its parameters.
template <class Visit>
void visit_types(const model::Member& member, Visit visit) {
  visit(member.type);
  for (const model::Parameter& parameter : member.parameters) visit(parameter.type);
  if (member.generator_parameter) visit(member.generator_parameter->type);
}

class Order {
 public:
  explicit Order(const Definition& definition) : definition_(definition) {
    for (const Declaration& declaration : definition.declarations) {
      std::visit([&](const auto* declared) { add(declared); }, declaration);
    }
  }

  std::vector<Declaration> result() && { return std::move(result_); }

 private:
  template <class Declared>
  void add(const Declared* declared) {
    result_.emplace_back(declared);
  }

  void add(const Record* record) {
    if (!begin(record, record->definition)) return;
    for (const model::Field& field : record->fields) {
      const auto* used = std::get_if<const Record*>(&field.type.base);
      if (used != nullptr && !closes_cycle(*record, **used)) add(*used);
    }
    result_.emplace_back(record);
  }

  void add(const Object* object) {
    if (!begin(object, object->definition)) return;
    for (const Object* base : object->implements) add(base);
    for (const model::Member& member : object->members) {
      visit_types(member, [&](const model::Type& type) {
        if (const auto* used = std::get_if<const Record*>(&type.base)) add(*used);
      });
    }
    result_.emplace_back(object);
  }

  bool begin(const void* declared, const Definition* owner) {
    return owner == &definition_ && seen_.insert(declared).second;
  }

  const Definition& definition_;
  std::unordered_set<const void*> seen_;
  std::vector<Declaration> result_;
};

/// Goes through an order and finds what is named before its turn.
class EarlyNames {
 public:
  explicit EarlyNames(const std::vector<Declaration>& order) {
    for (const Declaration& declaration : order) {
      if (const auto* record = std::get_if<const Record*>(&declaration)) {
        defined_.insert(*record);
        owner_ = (*record)->definition;
        for (const model::Field& field : (*record)->fields) name(field.type);
      } else if (const auto* object = std::get_if<const Object*>(&declaration)) {
        defined_.insert(*object);
        owner_ = (*object)->definition;
        for (const model::Member& member : (*object)->members) name(member.type);
      }
    }
  }

  std::vector<Declaration> result() && { return std::move(result_); }

 private:
  void name(const model::Type& type) {
    if (const auto* record = std::get_if<const Record*>(&type.base)) add(*record);
    if (const auto* object = std::get_if<const Object*>(&type.base)) add(*object);
  }

  template <class Declared>
  void add(const Declared* declared) {
    if (declared->definition == owner_ && defined_.insert(declared).second) {
      result_.emplace_back(declared);
    }
  }

  const Definition* owner_ = nullptr;
  std::unordered_set<const void*> defined_;
  std::vector<Declaration> result_;
};

}  // namespace

std::vector<Declaration> in_cpp_order(const Definition& definition) {
  return Order(definition).result();
}

std::vector<Declaration> named_early(const std::vector<Declaration>& order) {
  return EarlyNames(order).result();
}

}  // namespace robdef::cpp
