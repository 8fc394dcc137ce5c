// SPDX-License-Identifier: Apache-2.0
#include "runtime/c/src/tables.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <utility>

#include "rr/array.hpp"
#include "rr/error.hpp"
#include "runtime/c/src/border.hpp"
#include "runtime/cpp/src/client/definition_text.hpp"
#include "runtime/cpp/src/endpoint/client_version.hpp"

namespace rr::capi {
namespace {

Error wrong_definition(const std::string& what) {
  return {ErrorCode::service_definition_error, what};
}

std::shared_ptr<Stub> make_raw_stub() { return std::make_shared<RawStub>(); }

}  // namespace

OwnedDefinition::OwnedDefinition(std::string_view text, Imports imports)
    : text_(text), imports_(std::move(imports)) {
  client::DefinitionOutline outline = client::outline(text_);
  name_ = std::move(outline.name);
  objects_ = std::move(outline.objects);
  if (name_.empty()) throw wrong_definition("the text names no service");
  for (const auto& import : imports_) {
    const std::string_view name = import->definition().name;
    if (std::find(outline.imports.begin(), outline.imports.end(), name) == outline.imports.end()) {
      throw wrong_definition("`" + name_ + "` does not import `" + std::string(name) + "`");
    }
    import_views_.push_back(&import->definition());
  }
  if (import_views_.size() < outline.imports.size()) {
    throw wrong_definition("`" + name_ + "` imports more definitions than were given");
  }
  const std::string version = client::declared_version(text_);
  definition_ = {
      .name = name_,
      .text = text_,
      .version = version.empty() ? DefinitionVersion{} : endpoint::parse_version(version),
      .imports = import_views_,
      .records = {},
      .exceptions = {},
      .objects = {}};
}

std::vector<std::string> OwnedDefinition::implements(const std::string& object) const {
  const auto found = objects_.find(object);
  if (found == objects_.end()) {
    throw wrong_definition("`" + name_ + "` has no object `" + object + "`");
  }
  std::vector<std::string> stored;
  for (const std::string& name : found->second) {
    const std::size_t dot = name.rfind('.');
    stored.push_back(name.substr(0, dot) == name_ ? name.substr(dot + 1) : name);
  }
  return stored;
}

bool CheckedType::read(Decoder& decoder, const Element& element, void* value) const {
  if (!RawType::read(decoder, element, value)) return false;
  const rr_elements elements = static_cast<const Raw*>(value)->data.elements();
  const rr_status status = check_(context_, &elements);
  return status == RR_OK || decoder.fail(static_cast<ErrorCode>(status),
                                         "this is no value of the member's type", element.name);
}

OwnedObjectType::OwnedObjectType(std::shared_ptr<const OwnedDefinition> definition,
                                 std::string_view name, const rr_member* members,
                                 std::size_t member_count, std::size_t member_size)
    : definition_(std::move(definition)),
      name_(std::string(definition_->definition().name) + "." + std::string(name)),
      implements_(definition_->implements(std::string(name))),
      implements_views_(implements_.begin(), implements_.end()) {
  constexpr std::size_t most = 10'000;
  if (member_count > most || (member_count != 0 && members == nullptr)) {
    refuse_argument("the members are not there");
  }
  constexpr std::size_t first_size = offsetof(rr_member, check);  // of version 1.0
  if (member_size != sizeof(rr_member) && member_size != first_size) {
    refuse_argument("members have an unknown size");
  }
  members_.reserve(member_count);
  for (std::size_t i = 0; i < member_count; ++i) {
    rr_member member{};
    std::memcpy(&member, reinterpret_cast<const std::byte*>(members) + i * member_size,
                member_size);
    add(member);
  }
  type_ = std::make_unique<const ObjectType>(
      ObjectType{name_, definition_->definition(), implements_views_, members_, nullptr});
}

void OwnedObjectType::add(const rr_member& given) {
  if (given.kind > RR_MEMORY || given.generator > RR_GENERATOR_BOTH ||
      given.index > RR_INDEX_STRING) {
    refuse_argument("a member is of an unknown kind");
  }
  const std::string_view name = texts_.emplace_back(text(given.name));
  if (name.empty()) refuse_argument("a member has no name");
  Member member{.kind = static_cast<MemberKind>(given.kind),
                .access = static_cast<std::uint8_t>(given.access),
                .index = static_cast<IndexForm>(given.index),
                .generator = static_cast<GeneratorForm>(given.generator),
                .name = name};
  switch (member.kind) {
    case MemberKind::property:
      member.type = &raw_type;
      break;
    case MemberKind::pipe:
    case MemberKind::wire:
      member.type = &type_of(given);
      member.holding = &holding_of<Raw>;
      break;
    case MemberKind::function:
    case MemberKind::callback:
      if (given.returns_value != 0 || member.generator == GeneratorForm::returns ||
          member.generator == GeneratorForm::both) {
        member.type = &raw_type;
      }
      if (member.generator == GeneratorForm::takes || member.generator == GeneratorForm::both) {
        member.generator_parameter = &raw_type;
      }
      break;
    case MemberKind::memory:
      member.type = &memories_.emplace(members_.size(), std::make_unique<MemoryItems>(given.memory))
                         .first->second->type();
      break;
    case MemberKind::objref:
      member.object_type = texts_.emplace_back(text(given.object_type));
      break;
    case MemberKind::event:
      break;
  }
  members_.push_back(member);
}

const Type& OwnedObjectType::type_of(const rr_member& member) {
  if (member.check == nullptr) return raw_type;
  return checked_.emplace_back(member);
}

const Member& OwnedObjectType::member(std::uint32_t place, MemberKind kind) const {
  if (place >= members_.size() || members_[place].kind != kind) {
    refuse_argument("there is no such member of this kind");
  }
  return members_[place];
}

// One definition that a service has sent.
struct ClientTables::Told {
  Told(const std::string& from, ClientTables& tables);
  static void add(const client::DeclaredMember& declared, std::vector<Member>& members);

  std::string text;
  client::DefinitionOutline outline;
  std::vector<std::string> names;
  std::vector<std::vector<std::string_view>> implements;
  std::map<std::string, std::vector<client::DeclaredMember>> declared;
  std::deque<std::vector<Member>> members;
  std::deque<ToldObjectType> types;
  std::vector<const ObjectType*> views;
  Definition definition;
};

// What the runtime looks for by itself: callbacks that the service asks for, wires and pipes of
// subscriptions. The rest is the program's business.
void ClientTables::Told::add(const client::DeclaredMember& declared, std::vector<Member>& members) {
  Member member{.kind = MemberKind::callback, .name = declared.name, .type = &raw_type};
  if (declared.kind == "wire" || declared.kind == "pipe") {
    member.kind = declared.kind == "wire" ? MemberKind::wire : MemberKind::pipe;
    member.holding = &holding_of<Raw>;
  } else if (declared.kind != "callback") {
    return;
  }
  const auto has = [&](std::string_view modifier) {
    return declared.modifiers.find(modifier) != std::string::npos;
  };
  if (has("readonly")) member.access |= readonly;
  if (has("writeonly")) member.access |= writeonly;
  if (has("unreliable")) member.access |= unreliable;
  if (has("urgent")) member.access |= urgent;
  members.push_back(member);
}

ClientTables::Told::Told(const std::string& from, ClientTables& tables)
    : text(from), outline(client::outline(text)) {
  declared = client::declared_members(text);
  for (const auto& [name, others] : outline.objects) {
    names.push_back(outline.name + "." + name);
    implements.emplace_back(others.begin(), others.end());
    std::vector<Member>& used = members.emplace_back();
    for (const client::DeclaredMember& member : declared[name]) add(member, used);
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    types.push_back({{names[i], definition, implements[i], members[i], make_raw_stub}, &tables});
    views.push_back(&types.back());
  }
  definition = {.name = outline.name,
                .text = text,
                .version = {},
                .imports = {},
                .records = {},
                .exceptions = {},
                .objects = views};
}

ClientTables::ClientTables() = default;
ClientTables::~ClientTables() = default;

std::shared_ptr<const TypeRegistry> ClientTables::types() const {
  return {shared_from_this(), &first_};
}

void ClientTables::read(const std::map<std::string, std::string>& texts) {
  const MutexLock lock(mutex_);
  std::vector<const Told*> added;
  for (const auto& [name, text] : texts) {
    if (told_.contains(name)) continue;
    added.push_back(told_.emplace(name, std::make_unique<Told>(text, *this)).first->second.get());
  }
  if (added.empty()) return;
  TypeRegistry& before = registries_.empty() ? first_ : registries_.back();
  TypeRegistry& next = registries_.emplace_back();
  for (const Told* told : added) next.add(told->definition);
  before.continue_in(next);
}

const Member& ClientTables::member(std::string_view name, MemberKind kind, std::uint8_t access,
                                   bool has_value, const Type* type) {
  const MutexLock lock(mutex_);
  const auto [place, is_new] =
      members_.try_emplace(Key(std::string(name), kind, access, has_value, type));
  if (is_new) {
    place->second = {.kind = kind,
                     .access = access,
                     .name = std::get<0>(place->first),
                     .type = type != nullptr ? type : (has_value ? &raw_type : nullptr),
                     .generator_parameter = &raw_type,
                     .holding = &holding_of<Raw>};
  }
  return place->second;
}

const MemoryItems& ClientTables::memory(const rr_memory_type& memory) {
  const MutexLock lock(mutex_);
  return memories_.try_emplace({memory.element, memory.is_multi != 0, memory.transfer_size}, memory)
      .first->second;
}

bool ClientTables::is_a(std::string_view type, std::string_view other) const {
  std::vector<std::string_view> found = {type};
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i] == other) return true;
    const ObjectType* const known = first_.find_object(found[i]);
    if (known == nullptr) continue;
    for (const std::string_view name : known->implements) {
      if (std::find(found.begin(), found.end(), name) == found.end()) found.push_back(name);
    }
  }
  return false;
}

}  // namespace rr::capi

using rr::capi::guarded;
using rr::capi::need;

extern "C" {

rr_status rr_definition_new(rr_str text, rr_definition* const* imports, size_t import_count,
                            rr_definition** out_definition, rr_error** error) {
  return guarded(error, [&] {
    rr::capi::output(out_definition) = nullptr;
    rr::capi::OwnedDefinition::Imports list;
    for (size_t i = 0; i < import_count; ++i) {
      const auto* const import = (&need(imports, "there are no imports"))[i];
      list.push_back(need(import, "an import is NULL").definition);
    }
    *out_definition = new rr_definition{
        std::make_shared<rr::capi::OwnedDefinition>(rr::capi::text(text), std::move(list))};
  });
}

void rr_definition_release(rr_definition* definition) { rr::capi::release(definition); }

rr_status rr_object_type_new(rr_definition* definition, rr_str name, const rr_member* members,
                             size_t member_count, size_t member_size, rr_object_type** out_type,
                             rr_error** error) {
  return guarded(error, [&] {
    rr::capi::output(out_type) = nullptr;
    *out_type = new rr_object_type{std::make_shared<rr::capi::OwnedObjectType>(
        need(definition, "there is no definition").definition, rr::capi::text(name), members,
        member_count, member_size)};
  });
}

void rr_object_type_release(rr_object_type* type) { rr::capi::release(type); }

}  // extern "C"
