// SPDX-License-Identifier: Apache-2.0
#include "rr/varvalue.hpp"

#include <memory>
#include <new>

#include "rr/number.hpp"
#include "rr/registry.hpp"
#include "runtime/cpp/src/value/items.hpp"

namespace rr {
namespace {

// Sits in front of the value that it owns, in one allocation.
class alignas(16) HeldValue final : public Memory {
 public:
  explicit HeldValue(const ValueOperations& operations) : operations_(&operations) {}
  [[nodiscard]] void* place() { return this + 1; }

 private:
  ~HeldValue() = default;
  void destroy() noexcept override {
    operations_->destroy(place());
    this->~HeldValue();
    ::operator delete(this);
  }

  const ValueOperations* operations_;
};
static_assert(__STDCPP_DEFAULT_NEW_ALIGNMENT__ >= alignof(HeldValue));

struct BlockDeleter {
  void operator()(void* block) const { ::operator delete(block); }
};

// A value in a varvalue is allocated by itself.
bool reserve_held(Decoder& decoder, const Element& element, std::size_t size) {
  return decoder.reserve(value::allocation_cost + sizeof(HeldValue) + size, element.name);
}

template <class T>
bool read_as(Decoder& decoder, const Element& element, VarValue& value) {
  if (!reserve_held(decoder, element, sizeof(T))) return false;
  value = VarValue(type_of<T>, value_operations<T>);
  return type_of<T>.read(decoder, element, value.place());
}

bool read_multi_array(Decoder& decoder, const Element& element, VarValue& value) {
  Element array;
  if (!find_element(decoder, element.payload, element.count, "array", array)) {
    return decoder.fail(ErrorCode::message_element_not_found, "no such element", "array");
  }
  if (!is_number(array.type)) return value::fail_type(decoder, array);
  return with_number(array.type, [&]<class T>(std::type_identity<T>) {
    return read_as<MultiArray<T>>(decoder, element, value);
  });
}

const RecordType* find_record(Decoder& decoder, const Element& element) {
  const std::size_t dot = element.type_name.rfind('.');
  if (dot == std::string_view::npos) {
    decoder.fail(ErrorCode::invalid_argument, "type name is not qualified", element.name);
    return nullptr;
  }
  const RecordType* record =
      decoder.types() != nullptr ? decoder.types()->find_record(element.type_name) : nullptr;
  if (record == nullptr) {
    decoder.fail(ErrorCode::service_error, "unknown type", element.name);
  }
  return record;
}

// A struct, or an array of pods or namedarrays.
bool read_named(Decoder& decoder, const Element& element, VarValue& value) {
  const RecordType* record = find_record(decoder, element);
  if (record == nullptr) return false;
  const RecordOperations& operations = record->operations();
  const Type* type = operations.held_type != nullptr ? operations.held_type : record;
  const ValueOperations* of_value = operations.value;
  if (element.type == ElementType::pod_array || element.type == ElementType::namedarray_array) {
    type = operations.array;
    of_value = operations.array_value;
  } else if (element.type != ElementType::structure) {
    type = operations.multi_array;
    of_value = operations.multi_array_value;
  }
  // A pod's name on a struct, and the like.
  if (type == nullptr || type->element_type() != element.type) {
    return decoder.fail(ErrorCode::data_type_error, "type name of another kind", element.name);
  }
  if (!reserve_held(decoder, element, of_value->size)) return false;
  value = VarValue(*type, *of_value);
  return type->read(decoder, element, value.place());
}

}  // namespace

VarValue::VarValue(const Type& type, const ValueOperations& operations) : type_(&type) {
  std::unique_ptr<void, BlockDeleter> block(::operator new(sizeof(HeldValue) + operations.size));
  auto* held = ::new (block.get()) HeldValue(operations);
  operations.construct(held->place());
  static_cast<void>(block.release());
  place_ = held->place();
  memory_ = MemoryRef(held);
}

bool operator==(const VarValue& a, const VarValue& b) {
  if (a.type_ != b.type_) return false;
  if (a.place_ == b.place_) return true;
  // So that no type of a definition needs a comparison compiled for it.
  Writer first;
  Writer second;
  first.reset(MessageVersion::v4);
  second.reset(MessageVersion::v4);
  a.type_->write(first, "", a.place_);
  b.type_->write(second, "", b.place_);
  return first.copy() == second.copy();
}

void VarValue::throw_mismatch() {
  throw Error(ErrorCode::data_type_mismatch, "the varvalue holds another type");
}

void VarValueType::write(Writer& writer, const ElementName& name, const void* value) const {
  const auto& self = *static_cast<const VarValue*>(value);
  if (self.is_null()) {
    writer.null_element(name);
  } else {
    self.type()->write(writer, name, self.value());
  }
}

bool VarValueType::read(Decoder& decoder, const Element& element, void* value) const {
  auto& self = *static_cast<VarValue*>(value);
  if (is_number(element.type)) {
    return with_number(element.type, [&]<class T>(std::type_identity<T>) {
      return read_as<Array<T>>(decoder, element, self);
    });
  }
  switch (element.type) {
    case ElementType::void_:
      self = VarValue();
      return true;
    case ElementType::string:
      return read_as<std::string>(decoder, element, self);
    case ElementType::vector:
      return read_as<VarIntMap>(decoder, element, self);
    case ElementType::dictionary:
      return read_as<VarStringMap>(decoder, element, self);
    case ElementType::list:
      return read_as<VarList>(decoder, element, self);
    case ElementType::structure:
    case ElementType::pod_array:
    case ElementType::pod_multidimarray:
    case ElementType::namedarray_array:
    case ElementType::namedarray_multidimarray:
      return read_named(decoder, element, self);
    case ElementType::multidimarray:
      return read_multi_array(decoder, element, self);
    default:
      break;
  }
  return decoder.fail(ErrorCode::data_type_error, "no type of a varvalue", element.name);
}

}  // namespace rr
