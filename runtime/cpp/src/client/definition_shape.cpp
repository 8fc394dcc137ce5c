// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/client/definition_shape.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstddef>
#include <functional>
#include <optional>
#include <utility>

#include "runtime/cpp/src/client/definition_text.hpp"

namespace rr::client {
namespace {

// A declaration that is longer is compared so far.
constexpr std::size_t longest_shape = std::size_t{16} * 1024;

constexpr std::string_view built_in[] = {
    "void",  "double", "single", "int8", "uint8",   "int16",   "uint16",   "int32",    "uint32",
    "int64", "uint64", "string", "bool", "cdouble", "csingle", "varvalue", "varobject"};

constexpr std::string_view member_kinds[] = {"property", "function", "event", "objref",
                                             "pipe",     "callback", "wire",  "memory"};

template <class Words>
bool is_one_of(std::string_view word, const Words& words) {
  return std::find(std::begin(words), std::end(words), word) != std::end(words);
}

// The rest of a line, word by word.
class Line {
 public:
  // From the second word on.
  explicit Line(const std::vector<std::string_view>& words) {
    for (std::size_t i = 1; i < words.size() && text_.size() <= longest_shape; ++i) {
      text_.append(words[i]).append(1, ' ');
    }
    rest_ = text_;
  }
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;

  std::string_view word() {
    skip_blanks();
    std::size_t size = 0;
    while (size < rest_.size() && is_word(rest_[size])) ++size;
    return take(size);
  }
  // `[3,4]{list}` behind a type, without blanks; nothing where there is none.
  std::string brackets() {
    std::string found;
    while (skip_blanks(), !rest_.empty() && (rest_[0] == '[' || rest_[0] == '{')) {
      const std::size_t end = rest_.find(rest_[0] == '[' ? ']' : '}');
      if (end == std::string_view::npos) return found;
      for (const char c : take(end + 1)) {
        if (c != ' ') found += c;
      }
    }
    return found;
  }
  // Whether the next character is this one, which is then taken.
  bool takes(char c) {
    skip_blanks();
    if (rest_.empty() || rest_[0] != c) return false;
    rest_.remove_prefix(1);
    return true;
  }

 private:
  static bool is_word(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
  }
  void skip_blanks() {
    while (!rest_.empty() && rest_[0] == ' ') rest_.remove_prefix(1);
  }
  std::string_view take(std::size_t size) {
    const std::string_view taken = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return taken;
  }

  std::string text_;
  std::string_view rest_;
};

class Reader {
 public:
  explicit Reader(const DefinitionShape* wanted) : wanted_(wanted) {}

  DefinitionShape read(std::string_view text) {
    std::vector<std::string_view> words;
    while (next_line(text, words)) {
      if (enum_ != nullptr) {
        read_enum(words);
      } else if (words[0] == "end") {
        end_block();
      } else if (is_in_block_) {
        read_in_block(words);
      } else if (words.size() >= 2) {
        read_statement(words);
      }
    }
    return std::move(shape_);
  }

 private:
  using Words = std::vector<std::string_view>;

  void read_statement(const Words& words) {
    const std::string name(words[1].substr(0, longest_name));
    if (words[0] == "service") {
      service_ = name;
    } else if (words[0] == "using") {
      const std::string_view last = words[1].substr(words[1].rfind('.') + 1);
      aliases_[std::string(words.size() == 4 ? words[3] : last)] = name;
    } else if (words[0] == "object") {
      is_in_block_ = true;
      if (!wanted_ || wanted_->objects.contains(name)) object_ = &shape_.objects[name];
      object_name_ = name;
    } else if (words[0] == "struct" || words[0] == "pod" || words[0] == "namedarray") {
      is_in_block_ = true;
      is_struct_ = words[0] == "struct";
      if (!wanted_ || wanted_->records.contains(name)) {
        record_ = &shape_.records[name];
        record_->text = words[0];
      }
    } else if (words[0] == "enum") {
      // Others are read and forgotten.
      const bool is_wanted = !wanted_ || wanted_->enums.contains(name);
      enum_ = is_wanted ? &shape_.enums[name] : &forgotten_;
      next_value_ = 0;
      item_.clear();
    }
  }

  void read_in_block(const Words& words) {
    if (object_ != nullptr && is_one_of(words[0], member_kinds)) {
      read_member(words);
    } else if (record_ != nullptr && (words[0] == "field" || words[0] == "property")) {
      if (size_ > longest_shape) return;
      Line line(words);
      Shape field;
      read_type(line, field);
      field.text.append(1, ' ').append(line.word());
      record_->types.merge(field.types);
      size_ += field.text.size();
      if (is_struct_) {
        fields_.push_back(std::move(field.text));
      } else {
        record_->text += " " + field.text + ";";
      }
    }
  }

  void end_block() {
    std::sort(fields_.begin(), fields_.end());
    for (const std::string& field : fields_) record_->text += " " + field + ";";
    fields_.clear();
    size_ = 0;
    record_ = nullptr;
    object_ = nullptr;
    is_in_block_ = false;
  }

  void read_member(const Words& words) {
    Line line(words);
    Shape member;
    member.text = words[0];
    if (words[0] != "event") {
      member.text += ' ';
      read_type(line, member);
      if (words[0] == "objref") as_index(member.text);
    }
    const std::string_view name = line.word();
    if (name.empty() || name.size() > longest_name) return;
    if (wanted_) {
      const auto object = wanted_->objects.find(object_name_);
      if (!object->second.contains(name)) return;
    }
    if (line.takes('(')) read_parameters(line, member);
    object_->emplace(name, std::move(member));  // the first of a name counts
  }

  // Both mean the same.
  static void as_index(std::string& text) {
    if (text.ends_with("[]")) text.replace(text.size() - 2, 2, "{int32}");
  }

  void read_parameters(Line& line, Shape& member) {
    member.text += '(';
    bool is_first = true;
    while (!line.takes(')') && member.text.size() < longest_shape) {
      if (!std::exchange(is_first, false)) {
        if (!line.takes(',')) break;
        member.text += ',';
      }
      const std::size_t before = member.text.size();
      read_type(line, member);
      member.text.append(1, ' ').append(line.word());
      if (member.text.size() == before + 1) break;
    }
    member.text += ')';
  }

  // Appends a type.
  void read_type(Line& line, Shape& shape) {
    const std::string_view name = line.word();
    if (name.empty() || is_one_of(name, built_in)) {
      shape.text += name;
    } else {
      std::string full = qualified(name);
      shape.text += full;
      if (full.size() <= longest_name) shape.types.insert(std::move(full));
    }
    std::string brackets = line.brackets();
    if (brackets.starts_with("[0]")) brackets.erase(1, 1);  // no limit (06, Q08)
    if (brackets.starts_with("[0-]")) brackets.erase(1, 2);
    shape.text += brackets;
  }

  [[nodiscard]] std::string qualified(std::string_view name) const {
    if (const auto alias = aliases_.find(name); alias != aliases_.end()) return alias->second;
    if (name.find('.') != std::string_view::npos) return std::string(name);
    return service_ + "." + std::string(name);
  }

  // `A = 1, B, C` over any number of lines, up to `end`.
  void read_enum(const Words& words) {
    if (words[0] == "end") {
      end_item();
      enum_ = nullptr;
      forgotten_.clear();
      return;
    }
    for (const std::string_view word : words) {
      for (const char c : word) {
        if (c == ',') {
          end_item();
        } else if (item_.size() < longest_name) {
          item_ += c;
        }
      }
    }
  }

  void end_item() {
    const std::size_t equals = item_.find('=');
    const std::string name = item_.substr(0, equals);
    if (equals != std::string::npos) {
      if (const auto value = number(std::string_view(item_).substr(equals + 1))) {
        next_value_ = *value;
      }
    }
    if (!name.empty() && enum_ != &forgotten_) enum_->emplace(name, next_value_);
    ++next_value_;
    item_.clear();
  }

  static std::optional<long long> number(std::string_view text) {
    const bool is_negative = text.starts_with('-');
    if (is_negative || text.starts_with('+')) text.remove_prefix(1);
    const bool is_hex = text.starts_with("0x");
    if (is_hex) text.remove_prefix(2);
    std::int64_t wide = 0;
    const auto end =
        std::from_chars(text.data(), text.data() + text.size(), wide, is_hex ? 16 : 10);
    if (end.ec != std::errc() || wide > 0x80000000LL) return std::nullopt;
    return is_negative ? -wide : wide;
  }

  const DefinitionShape* const wanted_;
  DefinitionShape shape_;
  std::string service_;
  std::map<std::string, std::string, std::less<>> aliases_;
  bool is_in_block_ = false;
  bool is_struct_ = false;
  std::string object_name_;
  std::map<std::string, Shape, std::less<>>* object_ = nullptr;
  Shape* record_ = nullptr;
  std::vector<std::string> fields_;  // of a struct, whose order means nothing
  std::size_t size_ = 0;             // of a record's fields
  std::map<std::string, long long, std::less<>>* enum_ = nullptr;
  std::map<std::string, long long, std::less<>> forgotten_;
  std::string item_;
  long long next_value_ = 0;
};

}  // namespace

DefinitionShape shape_of(std::string_view text, const DefinitionShape* wanted) {
  return Reader(wanted).read(text);
}

}  // namespace rr::client
