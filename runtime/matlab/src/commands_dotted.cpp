// SPDX-License-Identifier: Apache-2.0
// What the user writes behind an object, as the interpreter hands it to the object's `subsref` and
// `subsasgn`. The usual cases are done here in one command, since a line of the toolbox takes the
// interpreter as long as all of this; the toolbox is told what is left to do.
#include <algorithm>
#include <array>
#include <string>

#include "rr/error.hpp"
#include "runtime/matlab/src/access.hpp"

namespace rr::matlab {
namespace {

/// What the toolbox has still to do, besides the kinds of Given that are more than a value. Numbers
/// that it knows.
enum class Left : int {
  none = 0,
  rest = 1,    ///< what stands behind a value
  own = 8,     ///< a name of the toolbox's own classes
  method = 9,  ///< a method that every object has
  part = 10,   ///< a part of a member is written, not the whole
};

/// The `subs` of the struct array that the interpreter gives to `subsref`, one for each dot or
/// parentheses: a text for a dot, cells for parentheses. Without their struct, which takes longer
/// to convert than the call.
class Subscripts {
 public:
  explicit Subscripts(std::span<const mxArray* const> given) : given_(given) {
    if (given.empty()) throw Misfit("expected what stands behind an object");
    if (!is_dot(0)) {
      throw Error(ErrorCode::invalid_operation, "an object of a service has no index");
    }
    name_ = read_text(given[0]);
    has_parentheses_ = count() > 1 && !is_dot(1);
    if (has_parentheses_) arguments_ = read_cells(given[1]);
  }

  [[nodiscard]] std::size_t count() const { return given_.size(); }
  [[nodiscard]] bool is_dot(std::size_t index) const { return !mxIsCell(given_[index]); }
  /// The name at `index`; empty for parentheses.
  [[nodiscard]] std::string name(std::size_t index) const {
    return is_dot(index) ? read_text(given_[index]) : std::string();
  }
  /// Behind the first dot.
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Whether parentheses are behind it, and what is in them.
  [[nodiscard]] bool has_parentheses() const { return has_parentheses_; }
  [[nodiscard]] const std::vector<const mxArray*>& arguments() const { return arguments_; }
  /// How many of the two belong to a call, or a property that is written with `()`.
  [[nodiscard]] std::size_t used(bool is_called) const {
    return has_parentheses_ && (is_called || arguments_.empty()) ? 2 : 1;
  }
  [[nodiscard]] bool is_own() const { return name_.starts_with("rr_"); }
  [[nodiscard]] bool is_method() const {
    static constexpr std::array names{"delete", "disp", "isvalid", "addlistener"};
    return std::find(names.begin(), names.end(), name_) != names.end();
  }

 private:
  const std::span<const mxArray* const> given_;
  std::string name_;
  bool has_parentheses_ = false;
  std::vector<const mxArray*> arguments_;
};

void give(Call& call, mxArray* value, int left, std::size_t used) {
  call.give(value);
  if (left == 0) return call.give(mxCreateDoubleScalar(0));
  mxArray* const numbers = mxCreateDoubleMatrix(1, 2, mxREAL);
  mxGetPr(numbers)[0] = left;
  mxGetPr(numbers)[1] = static_cast<double>(used);
  call.give(numbers);
}

// subsref(object, subs...): [value, left]. left is 0 if that is all, or [what, used]: what the
// toolbox has to do, and how many of the subscripts were used.
void subsref(Runtime& runtime, Call& call) {
  const Subscripts given(call.rest(1));
  const auto leave = [&](Left left) {
    give(call, make_null(), static_cast<int>(left), given.used(true));
  };
  // A closed object has these, too.
  if (given.is_own()) return leave(Left::own);
  if (given.is_method()) return leave(Left::method);
  const auto object = object_of(runtime, call);
  if (given.name().starts_with("async_")) {
    start_member(runtime, object, given.name().substr(6), given.arguments());
    return give(call, make_null(), static_cast<int>(Given::nothing), given.count());
  }
  const Accessed accessed = access_member(runtime, *object, given.name(), given.arguments());
  const std::size_t used = given.used(accessed.is_called());
  const Left left = given.count() > used ? Left::rest : Left::none;
  const bool is_value = accessed.kind == Given::value || accessed.kind == Given::result;
  give(call, accessed.value, is_value ? static_cast<int>(left) : static_cast<int>(accessed.kind),
       used);
}

// subsasgn(object, value, subs...): what is left, 0 for nothing
void subsasgn(Runtime& runtime, Call& call) {
  const Subscripts given(call.rest(2));
  Left left = Left::none;
  if (given.is_own()) {
    left = Left::own;
  } else if (given.count() > 1) {
    left = Left::part;
  } else {
    assign_member(runtime, *object_of(runtime, call), given.name(), call[1]);
  }
  call.give(mxCreateDoubleScalar(static_cast<double>(left)));
}

// Methods of what stands behind a member, of the toolbox's classes, that give nothing.
bool gives_nothing(std::string_view method) {
  static constexpr std::array names{"delete",       "disp",          "Abort", "Close",
                                    "PokeOutValue", "SetQueueLimit", "Write", "async_Next"};
  return std::find(names.begin(), names.end(), method) != names.end();
}

// The member of an object's type that a name means, as ObjectHandle::resolve() says; nullptr for
// none.
const dynamic::MemberDescription* find_member(
    const std::vector<dynamic::MemberDescription>& members, std::string_view name) {
  const auto find = [&](std::string_view wanted) {
    const auto found = std::find_if(members.begin(), members.end(),
                                    [&](const auto& member) { return member.name == wanted; });
    return found == members.end() ? nullptr : &*found;
  };
  const auto* const found = find(name);
  if (found != nullptr || !(name.starts_with("get_") || name.starts_with("set_"))) return found;
  return find(name.substr(4));
}

// Where only the service knows.
constexpr int unknown_count = -1;

// How many results the interpreter should ask for, of what stands behind an object of this type
// from `index` on: 0, 1 or unknown_count. Nothing is asked of the service.
int result_count(const dynamic::Definitions& types, const std::string& type_name,
                 const Subscripts& given, std::size_t index) {
  const std::string name = given.name(index);
  if (name.starts_with("async_")) return 0;
  const bool is_called = index + 1 < given.count() && !given.is_dot(index + 1);
  const std::size_t next = index + (is_called ? 2 : 1);
  const bool is_last = next >= given.count();
  if (type_name.empty()) return unknown_count;  // what a varobject is
  const std::vector<dynamic::MemberDescription> members = types.members(type_name);
  const dynamic::MemberDescription* const member = find_member(members, name);
  if (member == nullptr) return is_last && gives_nothing(name) ? 0 : 1;
  switch (member->kind) {
    case MemberKind::property:
      return name != member->name && name.starts_with("set_") ? 0 : 1;
    case MemberKind::function:
      if (member->generator == GeneratorForm::none) {
        return member->type.kind() == dynamic::Kind::null ? 0 : 1;
      }
      break;
    case MemberKind::objref:
      return is_last ? 1 : result_count(types, member->object_type, given, next);
    default:
      break;
  }
  if (is_last) return 1;
  const std::size_t last = given.count() - (given.name(given.count() - 1).empty() ? 2 : 1);
  return gives_nothing(given.name(last)) ? 0 : 1;
}

// result_count(object, subs...): how many results a reference has: 0, 1, or -1 for not known
void count_results(Runtime& runtime, Call& call) {
  const Subscripts given(call.rest(1));
  int count = 1;
  if (given.is_own() || given.is_method()) {
    count = gives_nothing(given.name()) ? 0 : 1;
  } else {
    try {
      const auto object = object_of(runtime, call);
      count = result_count(object->object().types(), object->object().type_name(), given, 0);
    } catch (const Error&) {
      // The reference itself says what is wrong.
    }
  }
  call.give(mxCreateDoubleScalar(count));
}

}  // namespace

std::vector<Command> dotted_commands() {
  return {{"subsref", subsref}, {"subsasgn", subsasgn}, {"result_count", count_results}};
}

}  // namespace rr::matlab
