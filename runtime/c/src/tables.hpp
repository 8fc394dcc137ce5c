// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "rr/definition.hpp"
#include "rr/mutex.hpp"
#include "rr/registry.hpp"
#include "rr/stub.hpp"
#include "runtime/c/src/elements.hpp"
#include "runtime/c/src/memory_types.hpp"
#include "runtime/cpp/src/client/definition_reader.hpp"

/// Definitions and members that are made at run time: what generated code has as constants. What
/// the runtime keeps pointers to stays until the node or session has gone that got it.
namespace rr::capi {

/// Keeps what is constant for the runtime.
class Keeper {
 public:
  void keep(std::shared_ptr<const void> constant) {
    const MutexLock lock(mutex_);
    kept_.insert(std::move(constant));
  }

 private:
  Mutex mutex_;
  std::set<std::shared_ptr<const void>> kept_ RR_GUARDED_BY(mutex_);
};

/// A definition from its text.
class OwnedDefinition {
 public:
  using Imports = std::vector<std::shared_ptr<const OwnedDefinition>>;
  /// Throws rr::Error (service_definition_error).
  OwnedDefinition(std::string_view text, Imports imports);
  OwnedDefinition(const OwnedDefinition&) = delete;
  OwnedDefinition& operator=(const OwnedDefinition&) = delete;

  [[nodiscard]] const Definition& definition() const { return definition_; }
  /// What an object implements, as stored in ObjectType. Throws rr::Error
  /// (service_definition_error) when there is no object of this name.
  [[nodiscard]] std::vector<std::string> implements(const std::string& object) const;

 private:
  const std::string text_;
  std::string name_;
  std::map<std::string, std::vector<std::string>> objects_;
  const Imports imports_;
  std::vector<const Definition*> import_views_;
  Definition definition_;
};

/// A member's values as the program checks them when they come.
class CheckedType final : public RawType {
 public:
  explicit CheckedType(const rr_member& member)
      : check_(member.check), context_(member.check_context) {}
  bool read(Decoder& decoder, const Element& element, void* value) const override;

 private:
  rr_status (*const check_)(void*, const rr_elements*);
  void* const context_;
};

/// An object's table of members.
class OwnedObjectType {
 public:
  /// Throws rr::Error.
  OwnedObjectType(std::shared_ptr<const OwnedDefinition> definition, std::string_view name,
                  const rr_member* members, std::size_t member_count, std::size_t member_size);
  OwnedObjectType(const OwnedObjectType&) = delete;
  OwnedObjectType& operator=(const OwnedObjectType&) = delete;

  [[nodiscard]] const ObjectType& type() const { return *type_; }
  /// Throws rr::Error (invalid_argument) unless there is a member of this kind at this place.
  [[nodiscard]] const Member& member(std::uint32_t place, MemberKind kind) const;
  /// What the memory at this place is of.
  [[nodiscard]] const MemoryItems& memory(std::uint32_t place) const {
    return *memories_.at(place);
  }
  [[nodiscard]] const std::shared_ptr<const OwnedDefinition>& definition() const {
    return definition_;
  }

 private:
  void add(const rr_member& member);
  [[nodiscard]] const Type& type_of(const rr_member& member);

  const std::shared_ptr<const OwnedDefinition> definition_;
  const std::string name_;
  std::vector<std::string> implements_;
  std::vector<std::string_view> implements_views_;
  std::deque<std::string> texts_;
  std::vector<Member> members_;
  std::deque<CheckedType> checked_;
  std::map<std::size_t, std::unique_ptr<const MemoryItems>> memories_;
  std::unique_ptr<const ObjectType> type_;
};

class ClientTables;

/// An object's type as a client knows it: by name, without members.
struct ToldObjectType : ObjectType {
  ClientTables* tables;
};

/// What one session knows: the types that the service's definitions name, and the members that were
/// asked for. The session keeps it, and so does whatever may outlive that.
class ClientTables final : public client::DefinitionReader,
                           public std::enable_shared_from_this<ClientTables> {
 public:
  ClientTables();
  ~ClientTables() override;
  [[nodiscard]] std::shared_ptr<const TypeRegistry> types() const override;
  void read(const std::map<std::string, std::string>& texts) override;
  [[nodiscard]] const Holding& holding() const override { return holding_of<Raw>; }
  [[nodiscard]] std::string_view name_of_values() const override { return "elements"; }

  /// The member of this name as it is to be used; always the same one. `kind` and `access` as they
  /// are, `form` of a generator, `type` of a memory or null for that of any value.
  const Member& member(std::string_view name, MemberKind kind, std::uint8_t access,
                       bool has_value = true, const Type* type = nullptr);
  /// What a memory is of; always the same one.
  const MemoryItems& memory(const rr_memory_type& memory);
  /// Whether `type` is `other`, or implements it.
  [[nodiscard]] bool is_a(std::string_view type, std::string_view other) const;

 private:
  struct Told;
  using Key = std::tuple<std::string, MemberKind, std::uint8_t, bool, const Type*>;

  TypeRegistry first_;
  mutable Mutex mutex_;
  std::map<std::string, std::unique_ptr<Told>> told_ RR_GUARDED_BY(mutex_);
  std::deque<TypeRegistry> registries_ RR_GUARDED_BY(mutex_);
  std::map<Key, Member> members_ RR_GUARDED_BY(mutex_);
  std::map<std::tuple<std::uint32_t, bool, std::uint32_t>, MemoryItems> memories_
      RR_GUARDED_BY(mutex_);
};

/// The stub of an object of any type.
class RawStub final : public Stub {
 public:
  [[nodiscard]] const ObjectType& rr_object_type() const override { return *type_; }
  void rr_take_object_type(const ObjectType& type) override {
    type_ = static_cast<const ToldObjectType*>(&type);
    tables_ = type_->tables->shared_from_this();
  }
  [[nodiscard]] ClientTables& tables() const { return *tables_; }
  [[nodiscard]] const std::shared_ptr<ClientTables>& shared_tables() const { return tables_; }

  using Stub::rr_connect;
  using Stub::rr_find;
  using Stub::rr_start_find;

 private:
  const ToldObjectType* type_ = nullptr;
  std::shared_ptr<ClientTables> tables_;
};

}  // namespace rr::capi

struct rr_definition {
  std::shared_ptr<const rr::capi::OwnedDefinition> definition;
};
struct rr_object_type {
  std::shared_ptr<const rr::capi::OwnedObjectType> type;
};
