// SPDX-License-Identifier: Apache-2.0
// Values that a program has made, as values of a declared type: arrays and containers.
#include <charconv>
#include <cstring>

#include "rr/error.hpp"
#include "runtime/cpp/src/dynamic/content.hpp"
#include "runtime/cpp/src/dynamic/definition_tables.hpp"
#include "runtime/cpp/src/dynamic/json.hpp"
#include "runtime/cpp/src/dynamic/nodes.hpp"
#include "runtime/cpp/src/dynamic/numbers.hpp"
#include "runtime/cpp/src/dynamic/tables.hpp"

namespace rr::dynamic {
namespace {

std::string text_of(const std::vector<std::uint32_t>& dims) {
  std::string text;
  for (const std::uint32_t dim : dims) text += (text.empty() ? "" : "x") + std::to_string(dim);
  return text;
}

std::string counted(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " item" : " items");
}

// A number, as JSON may spell it too.
bool is_number(const Value& value) {
  return value.kind() == Kind::number || value.kind() == Kind::text;
}

bool has_items_of(const ArrayContent& content, const ArrayNode& node) {
  if (content.number != node.number() || (content.record == nullptr) != (node.record() == nullptr))
    return false;
  return content.record == nullptr || content.record.get() == node.record() ||
         content.record->name == node.record()->name;
}

// Collects the items of an array in memory.
class Collector {
 public:
  Collector(const ArrayNode& node, std::size_t count)
      : node_(node), size_(node.wire_item().size), content_(std::make_shared<ArrayContent>()) {
    content_->number = node.number();
    if (node.record() != nullptr) content_->record = own(*node.record());
    content_->has_dims = node.has_dims();
    room_ = content_->data.items.make_room(count, size_);
    if (count * size_ != 0) std::memset(room_, 0, count * size_);
  }
  void set(std::size_t index, const Value& item, const Place& place) {
    const Value converted = node_.item()->convert(item, place);
    std::byte* const to = room_ + index * size_;
    if (node_.record() != nullptr) {
      pack(converted, *node_.record(), to);
    } else {
      std::memcpy(to, converted.bits(), size_);
    }
  }
  Value finish(std::vector<std::uint32_t> dims = {}) {
    content_->data.dims = std::move(dims);
    return value_of(Kind::array, std::move(content_));
  }

 private:
  const ArrayNode& node_;
  const std::size_t size_;
  std::shared_ptr<ArrayContent> content_;
  std::byte* room_ = nullptr;
};

// Nested lists, the first index outermost. Whether the items are lists themselves (complex numbers,
// namedarrays) only the type knows, so a shape is as deep as the lists are, less that.
class NestedLists {
 public:
  NestedLists(const ArrayNode& node, const Value& value, const Place& place)
      : node_(node), place_(place) {
    const std::size_t wanted = node.bounds().shape.size();
    const Value* level = &value;
    while (level->kind() == Kind::list && (wanted == 0 || dims_.size() < wanted)) {
      if (wanted == 0 && is_item(*level)) break;
      dims_.push_back(static_cast<std::uint32_t>(level->size()));
      if (level->size() == 0) break;
      level = &level->list()[0];
    }
    std::size_t stride = 1;
    for (const std::uint32_t dim : dims_) {
      strides_.push_back(stride);
      stride *= dim;
    }
    count_ = dims_.empty() ? 0 : stride;
  }
  Value collect(const Value& value) {
    check(value, 0, place_);  // before there is room for as many as the first lists promise
    Collector items(node_, count_);
    take(items, value, 0, 0, place_);
    return items.finish(dims_);
  }

 private:
  [[nodiscard]] bool is_item(const Value& level) const {
    const bool may_be =
        is_complex(node_.number()) ||
        (node_.record() != nullptr && node_.record()->kind == RecordKind::namedarray);
    return may_be && !dims_.empty() && level.size() != 0 && is_number(level.list()[0]);
  }
  void check(const Value& value, std::size_t depth, const Place& place) const {
    if (depth == dims_.size()) return;
    const bool is_list = value.kind() == Kind::list;
    if (!is_list || value.size() != dims_[depth]) {
      place.fail("expected a list of " + counted(dims_[depth]) + ", got " +
                 (is_list ? counted(value.size()) : value.type_text()));
    }
    for (std::size_t i = 0; i < value.size(); ++i) {
      check(value.list()[i], depth + 1, place.item(i));
    }
  }
  void take(Collector& items, const Value& value, std::size_t depth, std::size_t offset,
            const Place& place) {
    if (depth == dims_.size()) {
      items.set(offset, value, place);
      return;
    }
    for (std::size_t i = 0; i < value.size(); ++i) {
      take(items, value.list()[i], depth + 1, offset + i * strides_[depth], place.item(i));
    }
  }

  const ArrayNode& node_;
  const Place& place_;
  std::vector<std::uint32_t> dims_;
  std::vector<std::size_t> strides_;
  std::size_t count_ = 0;
};

// Numbers with one dimension more, the first, which is that of the numbers of each namedarray.
bool is_flat_of(const ArrayContent& content, const ArrayNode& node) {
  if (content.record != nullptr || !content.has_dims || node.record() == nullptr) return false;
  const auto& dims = content.data.dims;
  return node.record()->kind == RecordKind::namedarray && !dims.empty() &&
         dims[0] == node.record()->number_count && (node.has_dims() || dims.size() == 2);
}

// Their memory is that of the namedarrays.
Value gather_records(const Value& numbers, const ArrayNode& node, const Place& place) {
  const RecordTable& record = *node.record();
  const Value exact = number_array_node(record.number, true).convert(numbers, place);
  const auto& flat = content_of<ArrayContent>(exact).data;
  auto content = std::make_shared<ArrayContent>();
  content->number = node.number();
  content->record = own(record);
  content->has_dims = node.has_dims();
  content->data.items.share(flat.items.items(), flat.items.count() / record.number_count,
                            flat.items.owner());
  if (node.has_dims()) content->data.dims.assign(flat.dims.begin() + 1, flat.dims.end());
  return value_of(Kind::array, std::move(content));
}

}  // namespace

Value ArrayNode::convert(const Value& value, const Place& place) const {
  Value array = convert_items(value, place);
  check(array, place);
  return array;
}

Value ArrayNode::convert_items(const Value& value, const Place& place) const {
  if (value.kind() == Kind::array) {
    const auto& content = content_of<ArrayContent>(value);
    if (is_flat_of(content, *this)) return gather_records(value, *this, place);
    if (content.has_dims != has_dims()) refuse(value, place);
    if (has_items_of(content, *this)) return value;
    if (content.record != nullptr || record_ != nullptr) refuse(value, place);
    Collector items(*this, value.size());
    for (std::size_t i = 0; i < value.size(); ++i) items.set(i, value.at(i), place.item(i));
    return items.finish(content.data.dims);
  }
  if (value.kind() == Kind::string_map && has_dims()) {  // {dims, array}, for more than JSON shows
    const StringMap& map = value.string_map();
    if (map.size() != 2 || !value.has("dims") || !value.has("array")) refuse(value, place);
    const Value dims = number_array_node(ElementType::uint32, false)
                           .convert(value.at("dims"), place.field("dims"));
    const Value flat = value.at("array");
    if (flat.kind() != Kind::list) refuse(flat, place.field("array"));
    const Array<std::uint32_t> shape = dims.array<std::uint32_t>();
    Collector items(*this, flat.size());
    for (std::size_t i = 0; i < flat.size(); ++i) {
      items.set(i, flat.list()[i], place.field("array").item(i));
    }
    return items.finish({shape.begin(), shape.end()});
  }
  if (value.kind() != Kind::list) refuse(value, place);
  if (has_dims()) return NestedLists(*this, value, place).collect(value);
  Collector items(*this, value.size());
  for (std::size_t i = 0; i < value.size(); ++i) items.set(i, value.list()[i], place.item(i));
  return items.finish();
}

void ArrayNode::check(const Value& array, const Place& place) const {
  const std::size_t count = array.size();
  if (!has_dims()) {
    if (array_.takes(count)) return;
    place.fail("expected " + text() + ", got " + counted(count));
  }
  const auto& dims = content_of<ArrayContent>(array).data.dims;
  constexpr std::uint64_t too_many = ~std::uint64_t{0};
  std::uint64_t product = dims.empty() ? 0 : 1;
  for (const std::uint32_t dim : dims) {  // a 0 may come last
    if (__builtin_mul_overflow(product, dim, &product)) product = too_many;
  }
  if (product == too_many) place.fail("too many items");
  if (product != count) {
    place.fail("expected " + std::to_string(product) + " items for dims " + text_of(dims) +
               ", got " + std::to_string(count));
  }
  if (!bounds_.shape.empty() && dims != bounds_.shape) {
    place.fail("expected " + text() + ", got " + text_of(dims));
  }
}

Value ContainerNode::convert(const Value& value, const Place& place) const {
  if (place.is_too_deep()) place.fail("the value is too deep");
  if (value.is_null()) return value;
  if (kind() == Kind::list) return convert_list(value, place);
  return kind() == Kind::int_map ? convert_int_map(value, place) : convert_string_map(value, place);
}

Value ContainerNode::convert_list(const Value& value, const Place& place) const {
  if (value.kind() != Kind::list && (value.kind() != Kind::array || value.has_dims())) {
    refuse(value, place);
  }
  auto content = std::make_shared<ListContent>();
  const std::size_t size = value.size();
  content->items.reserve(size);
  for (std::size_t i = 0; i < size; ++i) {
    content->items.push_back(item_.convert(value.at(i), place.item(i)));
  }
  return value_of(Kind::list, std::move(content));
}

Value ContainerNode::convert_int_map(const Value& value, const Place& place) const {
  auto content = std::make_shared<IntMapContent>();
  if (value.kind() == Kind::int_map) {
    for (const auto& [key, item] : value.int_map()) {
      const std::string name = std::to_string(key);
      content->items.emplace(key, item_.convert(item, place.key(name)));
    }
  } else if (value.kind() == Kind::string_map && (place.is_json() || value.size() == 0)) {
    for (const auto& [name, item] : value.string_map()) {
      std::int32_t key = 0;
      const char* const end = name.data() + name.size();
      const auto [stop, error] = std::from_chars(name.data(), end, key);
      if (error != std::errc() || stop != end) {
        place.key(name).fail("expected a key of type int32");
      }
      content->items.emplace(key, item_.convert(item, place.key(name)));
    }
  } else {
    refuse(value, place);
  }
  return value_of(Kind::int_map, std::move(content));
}

Value ContainerNode::convert_string_map(const Value& value, const Place& place) const {
  auto content = std::make_shared<StringMapContent>();
  const auto take = [&](const std::string& name, const Value& item) {
    content->items.emplace(name, item_.convert(item, place.key(name)));
  };
  if (value.kind() == Kind::string_map) {
    for (const auto& [name, item] : value.string_map()) take(name, item);
  } else if (value.kind() == Kind::record && content_of<RecordContent>(value).table == nullptr) {
    for (const auto& [name, item] : value.fields()) take(name, item);
  } else {
    refuse(value, place);
  }
  return value_of(Kind::string_map, std::move(content));
}

namespace {

// JSON tells no types of numbers: the usual ones.
Value usual_number(const Value& value) {
  if (value.number_type() != ElementType::int64) return value;
  const auto number = value.as<std::int64_t>();
  return std::in_range<std::int32_t>(number) ? Value(static_cast<std::int32_t>(number)) : value;
}

Value typed_json(const Value& value, const Place& place) {
  const TypeNode* type = nullptr;
  try {
    type = &place.json_types()->type(value.at("type").text());
  } catch (const Error& error) {
    place.fail(error.message());
  }
  return type->convert(value.at("value"), place);
}

}  // namespace

// What has a type keeps it.
Value AnyNode::convert(const Value& value, const Place& place) const {
  if (place.is_json() && is_typed_json(value)) return typed_json(value, place);
  switch (value.kind()) {
    case Kind::number:
      return place.is_json() ? usual_number(value) : value;
    case Kind::list:
    case Kind::int_map:
    case Kind::string_map:
      return any_container_node(value.kind()).convert(value, place);
    case Kind::record:
      if (content_of<RecordContent>(value).table != nullptr) return value;
      return any_container_node(Kind::string_map).convert(value, place);
    default:
      return value;
  }
}

}  // namespace rr::dynamic
