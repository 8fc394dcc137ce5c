// SPDX-License-Identifier: Apache-2.0
#include "cli/live/members.hpp"

#include <algorithm>
#include <ostream>
#include <rr/error.hpp>
#include <rr/options.hpp>
#include <rr/printable.hpp>
#include <string>
#include <utility>

#include "cli/live/object_path.hpp"

namespace robdef::live {
namespace {

namespace dynamic = rr::dynamic;
using dynamic::MemberDescription;
using dynamic::Object;
using dynamic::Value;
using rr::MemberKind;

struct Found {
  Object object;
  MemberDescription member;
};

Found find(const Object& root, std::string_view text) {
  const MemberPath path = parse_member_path(text);
  Object object = object_at(root, path.object);
  MemberDescription member = object.member(path.member);
  return {std::move(object), std::move(member)};
}

std::string subject_of(const MemberDescription& member) { return "member " + member.name; }

[[noreturn]] void refuse_member(const MemberDescription& member, const std::string& expected) {
  throw rr::Error(rr::ErrorCode::member_format_mismatch,
                  subject_of(member) + ": expected " + expected + ", got " + kind_of(member));
}

// What a user has written for a value.
Value read_json(const dynamic::ValueType& type, const std::string& text,
                const std::string& subject) {
  try {
    return type.from_json(text, subject);
  } catch (const rr::Error& error) {
    if (error.code() != rr::ErrorCode::invalid_argument) throw;
    constexpr std::size_t most = 60;
    throw rr::Error(rr::ErrorCode::invalid_argument,
                    subject + ": expected " + type.text() + " as JSON, got `" +
                        (text.size() > most ? text.substr(0, most) + "..." : text) + "`" +
                        (type.kind() == dynamic::Kind::text ? "; a string has quotes" : ""));
  }
}

dynamic::Memory::Numbers position_in(const dynamic::Memory::Numbers& dims,
                                     const LiveOptions& options) {
  return options.position.value_or(dynamic::Memory::Numbers(dims.size(), 0));
}

// How much is read of a memory when nobody has said how much: a service may claim any length.
constexpr std::uint64_t most_bytes = 64ULL * 1024 * 1024;

void check_counts(const dynamic::Memory& memory, const dynamic::Memory::Numbers& counts,
                  const MemberDescription& member) {
  std::uint64_t items = 1;
  bool is_huge = false;
  for (const std::uint64_t count : counts) {
    is_huge = __builtin_mul_overflow(items, count, &items) || is_huge;
  }
  if (!is_huge && items <= most_bytes / memory.item_size()) return;
  throw rr::Error(rr::ErrorCode::invalid_argument,
                  subject_of(member) + ": " + (is_huge ? "its" : std::to_string(items)) +
                      " items are more than 64 MiB; say with `--count` how many to read");
}

Value read(const dynamic::Memory& memory, const MemberDescription& member,
           const LiveOptions& options) {
  dynamic::Memory::Numbers counts = memory.dims();
  const dynamic::Memory::Numbers position = position_in(counts, options);
  if (options.counts) return memory.read(position, *options.counts);
  for (std::size_t i = 0; i < std::min(counts.size(), position.size()); ++i) {
    counts[i] -= std::min(counts[i], position[i]);
  }
  check_counts(memory, counts, member);
  return memory.read(position, counts);
}

dynamic::List read_arguments(const MemberDescription& member, std::span<const std::string> texts) {
  dynamic::List arguments;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    // One too many is refused with all of them.
    arguments.push_back(
        i < member.parameters.size()
            ? read_json(member.parameters[i].type, texts[i],
                        subject_of(member) + ", parameter " + member.parameters[i].name)
            : Value());
  }
  return arguments;
}

class Steps {
 public:
  Steps(const Found& found, std::span<const std::string> texts, const LiveOptions& options,
        const std::function<std::optional<std::string>()>& next)
      : found_(found), options_(options), next_(next) {
    const std::size_t count = found.member.parameters.size();
    if (takes() && texts.size() > count) {
      steps_ = texts.subspan(count);
      texts = texts.first(count);
    }
    arguments_ = texts;
  }

  void run(std::ostream& out) {
    dynamic::Generator generator =
        found_.object.generate(found_.member.name, read_arguments(found_.member, arguments_));
    for (std::uint64_t count = 0; !options_.limit || count < *options_.limit; ++count) {
      Value given;
      if (takes()) {
        const std::optional<std::string> text = next_text(count);
        if (!text) break;
        given = read_json(found_.member.generator_parameter, *text, subject_of(found_.member));
      }
      const std::optional<Value> value = generator.next(given);
      if (!value) return;
      if (found_.member.generator == rr::GeneratorForm::takes) continue;
      out << rr::printable_json(found_.member.type.to_json(*value)) << std::endl;
    }
    generator.close();
  }

 private:
  [[nodiscard]] bool takes() const { return found_.member.generator != rr::GeneratorForm::returns; }
  [[nodiscard]] std::optional<std::string> next_text(std::uint64_t count) const {
    if (steps_.size() == 1 && steps_.front() == "-") return next_();
    if (count >= steps_.size()) return std::nullopt;
    return steps_[count];
  }

  const Found& found_;
  const LiveOptions& options_;
  const std::function<std::optional<std::string>()>& next_;
  std::span<const std::string> arguments_;
  std::span<const std::string> steps_;
};

// A service that has nothing to answer a peek with may still send a value to who connects.
bool may_send_instead(const rr::Error& refused) {
  switch (refused.code()) {
    case rr::ErrorCode::value_not_set:
    case rr::ErrorCode::invalid_operation:
    case rr::ErrorCode::not_implemented_error:
      return true;
    default:
      return false;
  }
}

Value newest_of(const dynamic::Wire& wire, const LiveOptions& options) {
  try {
    return wire.peek_in().value;
  } catch (const rr::Error& refused) {
    if (!may_send_instead(refused)) throw;
    const dynamic::WireConnection connection = wire.connect();
    const auto wait = options.timeout.value_or(rr::NodeOptions().request_timeout);
    if (!connection.wait_in(wait)) {
      throw rr::Error(refused.code(), refused.message() + "; no value was sent within " +
                                          std::to_string(wait.count()) + " ms either");
    }
    return connection.in();
  }
}

}  // namespace

std::string kind_of(const MemberDescription& member) {
  return member.declaration.substr(0, member.declaration.find(' '));
}

void get(const Object& root, std::string_view path, const LiveOptions& options, std::ostream& out) {
  const auto [object, member] = find(root, path);
  Value value;
  if (member.kind == MemberKind::property) {
    value = object.get(member.name);
  } else if (member.kind == MemberKind::wire) {
    value = newest_of(object.wire(member.name), options);
  } else if (member.kind == MemberKind::memory) {
    value = read(object.memory(member.name), member, options);
  } else {
    refuse_member(member, "property, wire or memory");
  }
  out << rr::printable_json(member.type.to_json(value)) << '\n';
}

void set(const Object& root, std::string_view path, const std::string& json,
         const LiveOptions& options) {
  const auto [object, member] = find(root, path);
  const bool is_memory = member.kind == MemberKind::memory;
  if (!is_memory && member.kind != MemberKind::property && member.kind != MemberKind::wire) {
    refuse_member(member, "property, wire or memory");
  }
  const Value value = read_json(member.type, json, subject_of(member));
  if (member.kind == MemberKind::property) {
    object.set(member.name, value);
  } else if (is_memory) {
    const dynamic::Memory memory = object.memory(member.name);
    memory.write(position_in(memory.dims(), options), value);
  } else {
    object.wire(member.name).poke_out(value);
  }
}

void call(const Object& root, std::string_view path, std::span<const std::string> arguments,
          const LiveOptions& options, const std::function<std::optional<std::string>()>& next_step,
          std::ostream& out) {
  const Found found = find(root, path);
  const MemberDescription& member = found.member;
  if (member.kind != MemberKind::function) refuse_member(member, "function");
  if (member.generator != rr::GeneratorForm::none) {
    Steps(found, arguments, options, next_step).run(out);
    return;
  }
  const Value result = found.object.call(member.name, read_arguments(member, arguments));
  if (member.type.kind() != dynamic::Kind::null) {
    out << rr::printable_json(member.type.to_json(result)) << '\n';
  }
}

}  // namespace robdef::live
