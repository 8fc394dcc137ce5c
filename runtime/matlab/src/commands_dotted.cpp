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

/// The argument of `subsref`: a struct array of `type` and `subs`, one for each dot or parentheses.
class Subscripts {
 public:
  explicit Subscripts(const mxArray* given) : given_(given), count_(count_of(given)) {
    if (!mxIsStruct(given) || count_ == 0) throw Misfit("expected what stands behind an object");
    if (type(0) != ".") {
      throw Error(ErrorCode::invalid_operation, "an object of a service has no index");
    }
    name_ = read_text(read_field(given, "subs"));
    has_parentheses_ = count_ > 1 && type(1) == "()";
    if (has_parentheses_) arguments_ = read_cells(read_field(given, "subs", 1));
  }

  [[nodiscard]] std::size_t count() const { return count_; }
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
  [[nodiscard]] std::string type(std::size_t index) const {
    return read_text(read_field(given_, "type", index));
  }
  const mxArray* const given_;
  const std::size_t count_;
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

// subsref(object, subscripts): [value, left]. left is 0 if that is all, or [what, used]: what the
// toolbox has to do, and how many of the subscripts were used.
void subsref(Runtime& runtime, Call& call) {
  const Subscripts given(call[1]);
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

// subsasgn(object, subscripts, value): what is left, 0 for nothing
void subsasgn(Runtime& runtime, Call& call) {
  const Subscripts given(call[1]);
  Left left = Left::none;
  if (given.is_own()) {
    left = Left::own;
  } else if (given.count() > 1) {
    left = Left::part;
  } else {
    assign_member(runtime, *object_of(runtime, call), given.name(), call[2]);
  }
  call.give(mxCreateDoubleScalar(static_cast<double>(left)));
}

}  // namespace

std::vector<Command> dotted_commands() { return {{"subsref", subsref}, {"subsasgn", subsasgn}}; }

}  // namespace rr::matlab
