// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "rr/dynamic_service.hpp"
#include "rr/mutex.hpp"
#include "rr/skeleton.hpp"
#include "rr/stored.hpp"
#include "runtime/cpp/src/dynamic/definition_tables.hpp"

namespace rr::dynamic {

/// A property that is kept by its object.
class PropertyStore {
 public:
  virtual ~PropertyStore() = default;
  [[nodiscard]] virtual Value get() const = 0;
  virtual void set(const Value& value) = 0;
};

/// A memory that is kept by its object.
class KeptMemory : public MemorySource {
 public:
  [[nodiscard]] virtual Value content() const = 0;
};

/// What the program has given for one member; empty for what it has not.
struct MemberFunctions {
  Function<Value()> get;
  Function<void(Reply)> get_later;
  Function<void(const Value&)> set;
  Function<void(const Value&, Reply)> set_later;
  std::shared_ptr<PropertyStore> store;
  Function<Value(const List&)> call;
  Function<void(const List&, Reply)> call_later;
  Function<Steps(const List&)> generate;
  Function<std::shared_ptr<Skeleton>(const Value&)> object;
  std::shared_ptr<MemorySource> memory;
  std::shared_ptr<KeptMemory> kept_memory;
};

/// What it has given for the whole object.
struct ObjectFunctions {
  Function<void(ServiceContext&, const std::string&)> attached;
  Function<void(const std::string&)> released;
  Function<bool(std::chrono::milliseconds)> enter_monitor;
  Function<void()> exit_monitor;
};

/// An object of any type, whose members are functions that may be changed at any time: a request
/// takes hold of those that are set when it comes.
class DynamicSkeleton final : public Skeleton {
 public:
  DynamicSkeleton(std::shared_ptr<const Tables> tables, const ObjectTable& table);

  [[nodiscard]] const ObjectTable& table() const { return table_; }
  [[nodiscard]] const std::shared_ptr<const Tables>& tables() const { return tables_; }
  [[nodiscard]] const Member& wire(const MemberTable& member) const { return table_.wire(member); }
  [[nodiscard]] MemberDescription describe(const MemberTable& member) const {
    return tables_->describe(table_, member);
  }

  [[nodiscard]] std::shared_ptr<const MemberFunctions> functions(const MemberTable& member) const;
  /// Changes the functions of a member by `change(MemberFunctions&)`, which does no more than
  /// assign.
  template <class Change>
  void change(const MemberTable& member, const Change& change) {
    const auto changed = std::make_shared<MemberFunctions>();
    std::shared_ptr<const MemberFunctions> place = changed;  // what goes, goes when the lock has
    const MutexLock lock(mutex_);
    auto& functions = functions_[place_of(member)];
    *changed = *functions;
    change(*changed);
    functions.swap(place);
  }
  [[nodiscard]] std::shared_ptr<const ObjectFunctions> functions() const;
  template <class Change>
  void change(const Change& change) {
    const auto changed = std::make_shared<ObjectFunctions>();
    std::shared_ptr<const ObjectFunctions> place = changed;
    const MutexLock lock(mutex_);
    *changed = *object_functions_;
    change(*changed);
    object_functions_.swap(place);
  }

  [[nodiscard]] const ObjectType& rr_object_type() const override { return *table_.wire_type; }
  void rr_attached(ServiceContext& context, const std::string& path) override;
  void rr_released(const std::string& path) override;
  void rr_dispatch(std::size_t place, Request& request) override;
  std::shared_ptr<Skeleton> rr_child(std::size_t place, const ObjectIndex& index) override;
  std::shared_ptr<MemorySource> rr_memory(std::size_t place) override;
  [[nodiscard]] bool rr_has_monitor() const override;
  bool rr_monitor_enter(std::chrono::milliseconds timeout) override;
  void rr_monitor_exit() override;

  using Skeleton::rr_ask_client;
  using Skeleton::rr_fire;
  using Skeleton::rr_start_asking;

 private:
  [[nodiscard]] std::size_t place_of(const MemberTable& member) const {
    return static_cast<std::size_t>(&member - table_.members.data());
  }
  void answer_get(const MemberTable& member, const MemberFunctions& given, Request& request) const;
  void answer_set(const MemberTable& member, const MemberFunctions& given, Request& request) const;
  void answer_call(const MemberTable& member, const MemberFunctions& given, Request& request) const;
  void answer_generator(const MemberTable& member, const MemberFunctions& given,
                        Request& request) const;

  const std::shared_ptr<const Tables> tables_;
  const ObjectTable& table_;
  mutable Mutex mutex_;
  std::vector<std::shared_ptr<const MemberFunctions>> functions_
      RR_GUARDED_BY(mutex_);  ///< as the members
  std::shared_ptr<const ObjectFunctions> object_functions_ RR_GUARDED_BY(mutex_);
};

}  // namespace rr::dynamic
