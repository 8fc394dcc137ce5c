// SPDX-License-Identifier: Apache-2.0
// The definitions that a service sends, and what they say otherwise than this program.
#include <utility>

#include "rr/error.hpp"
#include "rr/tap.hpp"
#include "rr/type.hpp"
#include "runtime/cpp/src/client/session.hpp"
#include "runtime/cpp/src/endpoint/client_version.hpp"
#include "runtime/cpp/src/endpoint/values.hpp"

namespace rr {

void Session::pull_definition(const std::string& name, const Patience& patience) {
  {
    const MutexLock lock(mutex_);
    if (texts_.contains(name)) return;
  }
  const std::string version(endpoint::own_version);
  constexpr Parameter parameters[] = {parameter<std::string>("ServiceType"),
                                      parameter<std::string>("clientversion")};
  const void* const values[] = {&name, &version};
  std::string definition;
  ask(
      {EntryType::get_service_desc, service_, {}, parameters, values},
      [&](Decoder& decoder, const Message&, const Entry& entry) {
        endpoint::read_value(decoder, entry, "servicedef", type_of<std::string>, &definition);
      },
      patience);
  keep_definition(definition);
}

// Everything that what is here imports, one by one.
void Session::pull_imports(const Patience& patience) {
  while (true) {
    std::optional<std::string> missing;
    {
      const MutexLock lock(mutex_);
      missing = texts_.missing_import();
    }
    if (!missing) return;
    pull_definition(*missing, patience);
    const MutexLock lock(mutex_);
    if (!texts_.contains(*missing)) {
      throw Error(ErrorCode::service_definition_error,
                  "the service sent another definition for `" + *missing + "`");
    }
  }
}

void Session::keep_definition(std::string_view text) {
  {
    const MutexLock lock(mutex_);
    texts_.count(text.size(), limits_.definitions);
  }
  if (core_->options().tap) core_->options().tap->definition(text);
  client::DefinitionOutline outline = client::outline(text);
  const MutexLock lock(mutex_);
  texts_.add(text, std::move(outline));
}

// Of a program that has read its types from these texts, nothing differs.
void Session::compare_definitions(const TypeRegistry& known) {
  const DefinitionCheck wanted =
      options_.definition_check.value_or(core_->options().definition_check);
  if (wanted == DefinitionCheck::off || options_.definition_reader) return;
  std::vector<client::MemberDifference> found;
  {
    const MutexLock lock(mutex_);
    found = differences_.compare(texts_.all(), known);
    if (!differences_.all().empty()) has_differences_.store(true, std::memory_order_release);
  }
  if (found.empty()) return;
  for (const client::MemberDifference& difference : found) {
    core_->log(LogLevel::warning, "service `" + service_ + "`: " + difference.text());
  }
  if (wanted == DefinitionCheck::refuse) {
    throw Error(ErrorCode::service_definition_error, found.front().text());
  }
}

void Session::refuse_member(const ObjectType& type, const Member& member) const {
  const MutexLock lock(mutex_);
  const client::MemberDifference* const difference = differences_.find(type.name, member.name);
  if (difference != nullptr) throw Error(difference->error());
}

bool Session::refuse_start(const Stub& stub, const Member& member,
                           std::unique_ptr<Completion>& completion) {
  try {
    check_member(stub, member);
    return false;
  } catch (const Error&) {
    // Not from inside the call that starts it.
    post({[shared = std::shared_ptr<Completion>(std::move(completion)),
           error = std::current_exception()]() mutable { shared->fail(std::move(error)); }});
    return true;
  }
}

}  // namespace rr
