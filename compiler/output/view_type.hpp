// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

/// What a template can know about a view: the names of its fields and what they hold. A view is an
/// ordinary struct; one line beside it lets templates print it and writes it as JSON:
///
///   struct FieldView {
///     std::string type;  ///< the C++ type
///     bool is_last = false;
///   };
///   ROBDEF_VIEW_TYPE(FieldView, type, is_last);  // in namespace robdef
///
/// What views of several languages have alike stands in a struct that they derive from; its own
/// `Facts::fields<View>()` gives its fields, which come first.
///
/// Fields are std::string, bool, another view, std::optional of a view, std::vector of a view or of
/// std::string.
namespace robdef {

class JsonWriter;
struct ViewField;

/// The fields of one view struct.
using ViewType = std::vector<ViewField>;

/// The table of a view struct. Specialized for each; the reference stays valid.
template <class View>
const ViewType& view_type();

enum class ViewKind { text, truth, view, optional_view, views, texts };

/// A field's value. `data` is a view, or the first of `count` views that are `stride` bytes apart.
struct ViewValue {
  std::string_view text = {};
  bool truth = false;
  const void* data = nullptr;
  std::size_t count = 0;
  std::size_t stride = 0;
};

/// One field of a view struct.
struct ViewField {
  std::string_view name;
  ViewKind kind{};
  const ViewType& (*type)() = nullptr;  ///< of what view, views and optional_view hold
  ViewValue (*get)(const void* view) = nullptr;
};

template <class Class, class Value>
Class class_of(Value Class::*);
template <class Class, class Value>
Value value_of(Value Class::*);

template <class Value>
struct ViewAccess {
  static constexpr ViewKind kind = ViewKind::view;
  static constexpr auto type = &view_type<Value>;
  static ViewValue get(const Value& value) { return {.data = &value, .count = 1}; }
};
template <>
struct ViewAccess<std::string> {
  static constexpr ViewKind kind = ViewKind::text;
  static constexpr const ViewType& (*type)() = nullptr;
  static ViewValue get(const std::string& value) { return {.text = value}; }
};
template <>
struct ViewAccess<bool> {
  static constexpr ViewKind kind = ViewKind::truth;
  static constexpr const ViewType& (*type)() = nullptr;
  static ViewValue get(const bool& value) { return {.truth = value}; }
};
template <class View>
struct ViewAccess<std::optional<View>> {
  static constexpr ViewKind kind = ViewKind::optional_view;
  static constexpr auto type = &view_type<View>;
  static ViewValue get(const std::optional<View>& value) {
    if (!value) return {};
    return {.data = &*value, .count = 1};
  }
};
template <class View>
struct ViewAccess<std::vector<View>> {
  static constexpr ViewKind kind = ViewKind::views;
  static constexpr auto type = &view_type<View>;
  static ViewValue get(const std::vector<View>& value) {
    return {.data = value.data(), .count = value.size(), .stride = sizeof(View)};
  }
};
template <>
struct ViewAccess<std::vector<std::string>> {
  static constexpr ViewKind kind = ViewKind::texts;
  static constexpr const ViewType& (*type)() = nullptr;
  static ViewValue get(const std::vector<std::string>& value) {
    return {.data = value.data(), .count = value.size(), .stride = sizeof(std::string)};
  }
};

/// Describes the field `Member` of `View`, a pointer to member, under the name that templates use.
template <auto Member, class View = decltype(class_of(Member))>
ViewField view_field(std::string_view name) {
  using Access = ViewAccess<decltype(value_of(Member))>;
  return {.name = name, .kind = Access::kind, .type = Access::type, .get = [](const void* view) {
            return Access::get(static_cast<const View*>(view)->*Member);
          }};
}

/// The fields that `View` has from `Facts`, and `own` behind them.
template <class Facts, class View>
ViewType fields_behind(const ViewType& own) {
  ViewType all = Facts::template fields<View>();
  all.insert(all.end(), own.begin(), own.end());
  return all;
}

/// The fields of a view: those of its facts, if it has some, and its own.
template <class View>
ViewType view_fields(const ViewType& own) {
  if constexpr (requires { typename View::Facts; }) {
    return fields_behind<typename View::Facts, View>(own);
  } else {
    return own;
  }
}

// Applies ROBDEF_VIEW_FIELD to each name; so many rounds reach 256 of them.
#define ROBDEF_VIEW_PARENTHESES ()
#define ROBDEF_VIEW_ROUNDS(...) ROBDEF_VIEW_ROUNDS3(ROBDEF_VIEW_ROUNDS3(__VA_ARGS__))
#define ROBDEF_VIEW_ROUNDS3(...) \
  ROBDEF_VIEW_ROUNDS2(ROBDEF_VIEW_ROUNDS2(ROBDEF_VIEW_ROUNDS2(ROBDEF_VIEW_ROUNDS2(__VA_ARGS__))))
#define ROBDEF_VIEW_ROUNDS2(...) \
  ROBDEF_VIEW_ROUNDS1(ROBDEF_VIEW_ROUNDS1(ROBDEF_VIEW_ROUNDS1(ROBDEF_VIEW_ROUNDS1(__VA_ARGS__))))
#define ROBDEF_VIEW_ROUNDS1(...) \
  ROBDEF_VIEW_ROUNDS0(ROBDEF_VIEW_ROUNDS0(ROBDEF_VIEW_ROUNDS0(ROBDEF_VIEW_ROUNDS0(__VA_ARGS__))))
#define ROBDEF_VIEW_ROUNDS0(...) __VA_ARGS__
#define ROBDEF_VIEW_FIELD(View, field) ::robdef::view_field<&View::field, View>(#field)
#define ROBDEF_VIEW_EACH(View, field, ...) \
  ROBDEF_VIEW_FIELD(View, field)           \
  __VA_OPT__(, ROBDEF_VIEW_AGAIN ROBDEF_VIEW_PARENTHESES(View, __VA_ARGS__))
#define ROBDEF_VIEW_AGAIN() ROBDEF_VIEW_EACH

/// The descriptions of these fields of a view, as a list.
#define ROBDEF_VIEW_FIELDS(View, ...) ROBDEF_VIEW_ROUNDS(ROBDEF_VIEW_EACH(View, __VA_ARGS__))

/// Defines the table of a view; the names that templates use are those of the fields.
#define ROBDEF_VIEW_TYPE(View, ...)                                           \
  template <>                                                                 \
  const ViewType& view_type<View>() {                                         \
    static const ViewType type =                                              \
        ::robdef::view_fields<View>({ROBDEF_VIEW_FIELDS(View, __VA_ARGS__)}); \
    return type;                                                              \
  }                                                                           \
  static_assert(true)

/// Writes one view as a JSON object, its fields in the order of the table.
void write_json(JsonWriter& json, const ViewType& type, const void* view);

/// The whole document for a root view.
template <class View>
std::string view_json(const View& view);
std::string view_json(const ViewType& type, const void* view);

template <class View>
std::string view_json(const View& view) {
  return view_json(view_type<View>(), &view);
}

}  // namespace robdef
