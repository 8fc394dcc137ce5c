// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/model/model.hpp"
#include "rr/definition.hpp"
#include "rr/dynamic_definitions.hpp"
#include "rr/mutex.hpp"
#include "rr/registry.hpp"
#include "runtime/cpp/src/dynamic/tables.hpp"

/// Definitions at run time: what generated code has as constants.
namespace rr::dynamic {

struct MemberTable {
  std::string name;
  std::string declaration;
  std::string documentation;
  std::string object_type;
  const TypeNode* type = nullptr;
  std::vector<std::pair<std::string, const TypeNode*>> parameters;
  const TypeNode* generator_parameter = nullptr;
  std::vector<Parameter> wire_parameters;
};

struct ObjectTable;

/// An object's description, which its stubs are given, and the table that it is of.
struct OwnedObjectType : ObjectType {
  const ObjectTable* table;
};

struct ObjectTable {
  ObjectTable() = default;
  ObjectTable(const ObjectTable&) = delete;
  ObjectTable& operator=(const ObjectTable&) = delete;

  const Tables* tables = nullptr;
  std::string name;  ///< qualified
  std::string documentation;
  std::vector<std::string> implements;
  std::vector<std::string_view> implements_views;
  std::vector<MemberTable> members;
  std::vector<Member> wire_members;  ///< in the same order
  std::unique_ptr<const OwnedObjectType> wire_type;

  /// Null when there is none of the name.
  [[nodiscard]] const MemberTable* find(std::string_view member) const;
  [[nodiscard]] const Member& wire(const MemberTable& member) const {
    return wire_members[static_cast<std::size_t>(&member - members.data())];
  }
};

struct DefinitionTable {
  std::string name;
  std::string text;
  std::string outline;
  DeclaredNames declared;
  std::vector<const RecordType*> records;
  std::vector<const ObjectType*> objects;
  std::vector<const Definition*> imports;
  Definition wire{};
};

/// Made once from texts, then read by any threads.
class Tables : public std::enable_shared_from_this<Tables> {
 public:
  using MakeStub = std::shared_ptr<Stub> (*)();
  Tables() = default;
  Tables(const Tables&) = delete;
  Tables& operator=(const Tables&) = delete;

  /// Throws rr::Error (service_definition_error). `make_stub` is for objects of all types.
  static std::shared_ptr<Tables> read(const std::vector<std::string>& texts, MakeStub make_stub);

  /// Throws rr::Error (invalid_argument).
  [[nodiscard]] const TypeNode& type(std::string_view text) const;
  [[nodiscard]] const ObjectTable* find_object(std::string_view name) const;
  [[nodiscard]] const std::map<std::string, DefinitionTable, std::less<>>& definitions() const {
    return definitions_;
  }
  /// Null for what has none.
  [[nodiscard]] const Fields* find_constants(std::string_view scope) const;
  [[nodiscard]] const TypeRegistry& registry() const { return registry_; }
  [[nodiscard]] TypeRegistry& registry() { return registry_; }
  [[nodiscard]] ValueType handle(const TypeNode* node) const {
    return node == nullptr ? ValueType() : ValueType(shared_from_this(), node);
  }
  [[nodiscard]] MemberDescription describe(const ObjectTable& object,
                                           const MemberTable& member) const;

 private:
  friend class TableBuilder;
  /// What an array and a container are of.
  struct Base {
    const TypeNode* node = nullptr;
    const RecordTable* record = nullptr;
    ElementType number = ElementType::void_;
  };
  Base find_base(std::string_view name) const RR_REQUIRES(mutex_);
  const TypeNode& make_array(const Base& base, ArrayBounds bounds, const std::string& text) const
      RR_REQUIRES(mutex_);
  const TypeNode& make_container(const TypeNode& item, Kind kind, const std::string& text) const
      RR_REQUIRES(mutex_);

  std::map<std::string, RecordTable, std::less<>> records_;
  std::map<std::string, EnumTable, std::less<>> enums_;
  std::map<std::string, ObjectTable, std::less<>> objects_;
  std::map<std::string, DefinitionTable, std::less<>> definitions_;
  std::map<std::string, Fields, std::less<>> constants_;  // by their scope
  TypeRegistry registry_;
  // Made when they are asked for; nodes never go.
  mutable Mutex mutex_;
  mutable std::map<std::string, std::unique_ptr<const TypeNode>, std::less<>> nodes_
      RR_GUARDED_BY(mutex_);
};

}  // namespace rr::dynamic
