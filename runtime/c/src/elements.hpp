// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "rr/buffer.hpp"
#include "rr/definition.hpp"
#include "rr/holding.hpp"
#include "rr/reader.hpp"
#include "rr/type_of.hpp"
#include "runtime/c/include/rr.h"

/// Values as elements: what the runtime carries for programs that read and write them themselves.
struct rr_data {
  rr_data(rr::MemoryRef keeper, std::span<const std::byte> of, std::uint32_t elements,
          std::uint32_t format)
      : owner(std::move(keeper)), bytes(of), count(elements), version(format) {}

  const rr::MemoryRef owner;
  const std::span<const std::byte> bytes;
  const std::uint32_t count;
  const std::uint32_t version;  ///< of the message format; 0 for what is no elements
  std::atomic<std::uint32_t> references{1};
};

namespace rr::capi {

/// A reference to received bytes; may be none.
class Data {
 public:
  Data() = default;
  Data(const Data& other) : data_(rr_data_retain(other.data_)) {}
  Data(Data&& other) noexcept : data_(std::exchange(other.data_, nullptr)) {}
  Data& operator=(Data other) noexcept {
    std::swap(data_, other.data_);
    return *this;
  }
  ~Data() { rr_data_release(data_); }

  /// Bytes that are kept by `owner`, or copied when it is none.
  static Data of(const MemoryRef& owner, std::span<const std::byte> bytes, std::uint32_t count,
                 MessageVersion version);
  static Data copy(std::span<const std::byte> bytes, std::uint32_t count, std::uint32_t version);
  static Data text(std::string_view text);

  [[nodiscard]] rr_data* get() const { return data_; }
  /// The program's reference.
  [[nodiscard]] rr_data* hand_out() && { return std::exchange(data_, nullptr); }
  [[nodiscard]] rr_elements elements() const { return rr_data_elements(data_); }
  explicit operator bool() const { return data_ != nullptr; }

 private:
  explicit Data(rr_data* data) : data_(data) {}
  rr_data* data_ = nullptr;
};

/// One value: an element and what keeps its bytes, if anything does. What the runtime takes for a
/// value of a member is one of these.
struct Raw {
  Element element;
  MessageVersion version = MessageVersion::v4;
  Data data;  ///< none: the bytes are the caller's
  bool has_references = false;
};

/// What an element is written from besides itself.
struct Origin {
  MessageVersion version = MessageVersion::v4;
  const Decoder* codes = nullptr;  ///< spells out those that are in it; null when there are none
  bool has_references = false;     ///< stand for arrays inside of it
  MemoryRef owner{};               ///< keeps the bytes; may be none
};

/// Writes an element under a name, in the writer's version of the format. What cannot be read fails
/// the writer.
void write_element(Writer& writer, const ElementName& name, const Element& element,
                   const Origin& origin);

/// How a Raw travels. Stands for every type of a definition.
class RawType : public Type {
 public:
  constexpr RawType() = default;
  [[nodiscard]] ElementType element_type() const override { return ElementType::void_; }
  void write(Writer& writer, const ElementName& name, const void* value) const override;
  bool read(Decoder& decoder, const Element& element, void* value) const override;
};
inline constexpr RawType raw_type;

/// Elements that the program hands in, checked, as the runtime takes values: one parameter each.
class Values {
 public:
  /// NULL: none. Throws rr::Error (data_serialization_error).
  explicit Values(const rr_elements* elements);
  Values(const Values&) = delete;
  Values& operator=(const Values&) = delete;

  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] MessageVersion version() const { return version_; }
  /// Throws rr::Error (data_serialization_error) when an array lies elsewhere.
  [[nodiscard]] std::span<const std::byte> bytes() const;
  [[nodiscard]] std::span<const Parameter> parameters() const { return {parameters_, count_}; }
  [[nodiscard]] const void* const* places() const { return places_; }
  /// The only one. Throws rr::Error (data_serialization_error) unless there is just one.
  [[nodiscard]] const Raw& single() const;

 private:
  static constexpr std::size_t few = 4;
  void make_room(std::size_t count);

  std::span<const std::byte> bytes_;
  MessageVersion version_ = MessageVersion::v4;
  bool has_references_ = false;
  std::size_t count_ = 0;
  std::array<Raw, few> few_raws_;
  std::array<Parameter, few> few_parameters_;
  std::array<const void*, few> few_places_;
  Raw* raws_ = few_raws_.data();
  Parameter* parameters_ = few_parameters_.data();
  const void** places_ = few_places_.data();
  std::vector<Raw> raws_memory_;
  std::vector<Parameter> parameters_memory_;
  std::vector<const void*> places_memory_;
};

/// A value that stays: a copy of what the program hands in.
Raw keep(const Raw& raw);
/// The elements of a received entry.
Data read_entry(Decoder& decoder, const Entry& entry);
/// A value that the runtime has for the program, as one element. Throws rr::Error.
Data write_data(const Type& type, const void* value, std::string_view name);

}  // namespace rr::capi
