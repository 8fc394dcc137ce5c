// SPDX-License-Identifier: Apache-2.0
#include "rr/container_type.hpp"
#include "runtime/cpp/src/value/items.hpp"

namespace rr {
namespace {

// Calls `read` with each element of a list, in order, after checking its number.
template <class Read>
bool read_list(Decoder& decoder, const Element& list, const Read& read) {
  const Descent descent(decoder, list.name);
  if (!descent) return false;
  ElementReader reader(decoder, list);
  Element element;
  for (std::uint32_t i = 0; i < list.count; ++i) {
    if (!reader.next(element)) return false;
    if (element.index() != static_cast<std::int32_t>(i)) {
      return decoder.fail(ErrorCode::data_type_error, "items of a list out of order", list.name);
    }
    if (!read(i, element)) return false;
  }
  return true;
}

class MapWriter final : public MapOperations::Visitor {
 public:
  MapWriter(Writer& writer, const Type& item) : writer_(&writer), item_(&item) {}
  void visit(std::int32_t key, const void* item) override {
    item_->write(*writer_, ElementName(key), item);
  }
  void visit(const std::string& key, const void* item) override {
    item_->write(*writer_, std::string_view(key), item);
  }

 private:
  Writer* writer_;
  const Type* item_;
};

// What an item of a std::map takes besides key and value: its node, and the allocation of it.
constexpr std::size_t map_node_size = 80;

// Adds the item that an element names. Null when the key is there already; with the decoder failed
// when it is no key.
void* add_item(Decoder& decoder, const Element& map, const Element& element,
               const MapOperations& operations, void* value) {
  if (operations.add_number != nullptr) {
    if (const std::optional<std::int32_t> key = element.index()) {
      return operations.add_number(value, *key);
    }
  } else if (element.has_name) {
    constexpr std::size_t in_place = 15;  // so long a key needs no memory of its own
    if (element.name.size() > in_place &&
        !decoder.reserve(element.name.size() + value::allocation_cost, map.name)) {
      return nullptr;
    }
    return operations.add_text(value, element.name);
  }
  decoder.fail(ErrorCode::data_type_error, "item of a map without a key", map.name);
  return nullptr;
}

}  // namespace

[[gnu::hot]] void NullableType::write(Writer& writer, const ElementName& name,
                                      const void* value) const {
  if (const void* inner = operations_->get(value)) {
    value_->write(writer, name, inner);
  } else {
    writer.null_element(name);
  }
}

[[gnu::hot]] bool NullableType::read(Decoder& decoder, const Element& element, void* value) const {
  if (element.type != ElementType::void_) {
    return value_->read(decoder, element, operations_->engage(value));
  }
  operations_->reset(value);
  return true;
}

void ListType::write(Writer& writer, const ElementName& name, const void* value) const {
  if (operations_->items == nullptr) {
    write_bools(writer, name, *static_cast<const std::vector<bool>*>(value));
    return;
  }
  const Descent descent(writer, name.text);
  if (!descent) return;
  const std::size_t end = writer.position();
  const std::size_t size = operations_->size(value);
  const auto* item =
      static_cast<const std::byte*>(operations_->items(value)) + size * operations_->item_size;
  for (std::size_t i = size; i-- > 0;) {
    item -= operations_->item_size;
    item_->write(writer, ElementName(static_cast<std::int32_t>(i)), item);
  }
  writer.element(name, ElementType::list, {}, static_cast<std::uint32_t>(size), end);
}

bool ListType::read(Decoder& decoder, const Element& element, void* value) const {
  if (element.type != ElementType::list) return value::fail_type(decoder, element);
  if (operations_->items == nullptr) {
    return read_bools(decoder, element, *static_cast<std::vector<bool>*>(value));
  }
  if (!decoder.reserve(element.count * operations_->item_size, element.name)) return false;
  auto* items = static_cast<std::byte*>(operations_->resize(value, element.count));
  return read_list(decoder, element, [&](std::uint32_t i, const Element& item) {
    return item_->read(decoder, item, items + i * operations_->item_size);
  });
}

void ListType::write_bools(Writer& writer, const ElementName& name,
                           const std::vector<bool>& list) const {
  const Descent descent(writer, name.text);
  if (!descent) return;
  const std::size_t end = writer.position();
  for (std::size_t i = list.size(); i-- > 0;) {
    const bool item = list[i];
    item_->write(writer, ElementName(static_cast<std::int32_t>(i)), &item);
  }
  writer.element(name, ElementType::list, {}, static_cast<std::uint32_t>(list.size()), end);
}

bool ListType::read_bools(Decoder& decoder, const Element& element, std::vector<bool>& list) const {
  list.resize(element.count);
  return read_list(decoder, element, [&](std::uint32_t i, const Element& item) {
    bool flag = false;
    if (!item_->read(decoder, item, &flag)) return false;
    list[i] = flag;
    return true;
  });
}

void MapType::write(Writer& writer, const ElementName& name, const void* value) const {
  const Descent descent(writer, name.text);
  if (!descent) return;
  const std::size_t end = writer.position();
  MapWriter items(writer, *item_);
  operations_->visit(value, items);
  writer.element(name, element_type_, {}, static_cast<std::uint32_t>(operations_->size(value)),
                 end);
}

bool MapType::read(Decoder& decoder, const Element& element, void* value) const {
  if (element.type != element_type_) return value::fail_type(decoder, element);
  if (!decoder.reserve(element.count * (operations_->item_size + map_node_size), element.name)) {
    return false;
  }
  const Descent descent(decoder, element.name);
  if (!descent) return false;
  operations_->clear(value);
  ElementReader reader(decoder, element);
  Element item;
  while (reader.next(item)) {
    if (void* place = add_item(decoder, element, item, *operations_, value)) {
      if (!item_->read(decoder, item, place)) return false;
    } else if (decoder.failed()) {
      return false;
    }
  }
  return !decoder.failed();
}

}  // namespace rr
