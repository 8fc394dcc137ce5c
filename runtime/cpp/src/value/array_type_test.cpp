// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <numeric>

#include "runtime/cpp/src/value/conformance_types.hpp"
#include "runtime/cpp/src/value/testing.hpp"

// Arrays of numbers (03, sections 3, 4, 5, 11, 12) and who owns their items.
namespace rr::testing_values {
namespace {

TEST(NumberArray, HasTheBytesOfTheStandard) {
  EXPECT_EQ(encode(Array<bool>{true}), from_hex("0c 01" + value_name + "0e 00 01 01"));
  EXPECT_EQ(encode(Array<double>{}), from_hex("0b 01" + value_name + "01 00 00"));
}

TEST(NumberArray, SurvivesInEveryForm) {
  EXPECT_TRUE(survives(Array<double>{1, -2, 0.5}));
  EXPECT_TRUE(survives(Array<std::uint8_t>{}));
  EXPECT_TRUE(survives(Array<std::complex<double>>{{1, 2}, {3, 4}}));
  EXPECT_TRUE(survives(std::array<std::int16_t, 3>{1, -2, 3}));
  EXPECT_TRUE(survives(BoundedArray<std::uint64_t, 4>{1, 2}));
  EXPECT_TRUE(survives(BoundedArray<std::uint8_t, 4>{1, 2, 3, 4}));
  EXPECT_TRUE(survives(BoundedArray<double, 4>{}));
  EXPECT_TRUE(survives(MultiArray<float>{{2, 1}, {1, 2}}));
  EXPECT_TRUE(survives(FixedMultiArray<std::int32_t, 2, 2>{{1, 2, 3, 4}}));
}

TEST(NumberArray, NullIsAnErrorOfItsOwn) {
  EXPECT_EQ(error_of<Array<double>>(null_of("value")), ErrorCode::null_value);
  EXPECT_EQ((error_of<std::array<double, 1>>(null_of("value"))), ErrorCode::null_value);
  EXPECT_EQ((error_of<BoundedArray<double, 1>>(null_of("value"))), ErrorCode::null_value);
  EXPECT_EQ(error_of<MultiArray<double>>(null_of("value")), ErrorCode::null_value);
  EXPECT_EQ((error_of<FixedMultiArray<double, 1, 1>>(null_of("value"))), ErrorCode::null_value);
}

TEST(NumberArray, AnotherTypeIsAMismatch) {
  const ElementTree numbers = numbers_of<float>("value", {1});
  EXPECT_EQ(error_of<Array<double>>(numbers), ErrorCode::data_type_mismatch);
  EXPECT_EQ((error_of<std::array<double, 1>>(numbers)), ErrorCode::data_type_mismatch);
  EXPECT_EQ(error_of<MultiArray<float>>(numbers), ErrorCode::data_type_mismatch);
}

TEST(NumberArray, LengthsAreChecked) {
  const ElementTree three = numbers_of<double>("value", {1, 2, 3});
  EXPECT_EQ((error_of<std::array<double, 4>>(three)), ErrorCode::data_type_error);
  EXPECT_EQ((error_of<std::array<double, 2>>(three)), ErrorCode::data_type_error);
  EXPECT_EQ((error_of<std::array<double, 3>>(three)), ErrorCode::none);
  EXPECT_EQ((error_of<BoundedArray<double, 2>>(three)), ErrorCode::data_type_error);
  EXPECT_EQ((error_of<BoundedArray<double, 3>>(three)), ErrorCode::none);
}

template <class Description>
ErrorCode error_as(const ElementTree& tree) {
  const std::vector<std::byte> bytes = bytes_of(tree);
  Decoder decoder(MessageVersion::v4);
  ElementReader reader(decoder, bytes, 1);
  Element element;
  Array<double> array;
  if (reader.next(element)) type_of<Description>.read(decoder, element, &array);
  return decoder.code();
}
template <class Description>
ErrorCode sending_error_as(const Array<double>& array) {
  Writer writer;
  writer.reset(MessageVersion::v4);
  type_of<Description>.write(writer, "value", &array);
  return writer.code();
}

TEST(NumberArray, LengthsOfLargeArraysAreCheckedBothWays) {
  const ElementTree three = numbers_of<double>("value", {1, 2, 3});
  EXPECT_EQ((error_as<FixedLength<double, 3>>(three)), ErrorCode::none);
  EXPECT_EQ((error_as<FixedLength<double, 4>>(three)), ErrorCode::data_type_error);
  EXPECT_EQ((error_as<MaximumLength<double, 3>>(three)), ErrorCode::none);
  EXPECT_EQ((error_as<MaximumLength<double, 2>>(three)), ErrorCode::data_type_error);
  const Array<double> array{1, 2, 3};
  EXPECT_EQ((sending_error_as<FixedLength<double, 3>>(array)), ErrorCode::none);
  EXPECT_EQ((sending_error_as<FixedLength<double, 2>>(array)), ErrorCode::data_type_error);
  EXPECT_EQ((sending_error_as<MaximumLength<double, 4>>(array)), ErrorCode::none);
  EXPECT_EQ((sending_error_as<MaximumLength<double, 2>>(array)), ErrorCode::data_type_error);
}

TEST(NumberArray, OddBytesOfBoolsAreNormalized) {
  ElementTree element = numbers_of<bool>("value", {true, false, true});
  element.payload[2] = std::byte{7};
  EXPECT_EQ(encode(value_of<Array<bool>>(element)), encode(Array<bool>{true, false, true}));
  EXPECT_EQ(encode(value_of<std::array<bool, 3>>(element)), encode(Array<bool>{true, false, true}));
}

// A received message of one element, at an address whose remainder by 16 can be chosen.
struct Received {
  Received(const std::vector<std::byte>& element, std::size_t shift)
      : memory(allocate(element.size() + shift)),
        bytes(memory.bytes + shift, element.size()),
        decoder(MessageVersion::v4, nullptr, memory.owner) {
    std::memcpy(memory.bytes + shift, element.data(), element.size());
    ElementReader reader(decoder, bytes, 1);
    reader.next(root);
  }
  template <class T>
  T read() {
    T value;
    EXPECT_TRUE(type_of<T>.read(decoder, root, &value)) << decoder.message();
    return value;
  }
  [[nodiscard]] bool holds(const void* data) const {
    return data >= bytes.data() && data < bytes.data() + bytes.size();
  }

  Allocation memory;
  std::span<const std::byte> bytes;
  Decoder decoder;
  Element root;
};

Array<double> counting(std::size_t size) {
  Array<double> array(size);
  const auto items = array.mutate();
  std::iota(items.begin(), items.end(), 0.0);
  return array;
}

// The bytes before the payload of a double array called value whose size and count take three
// bytes.
constexpr std::size_t header_size = 3 + 1 + 6 + 2 + 3;

TEST(ReceivedArray, IsASliceWhenLargeAndAligned) {
  const Array<double> array = counting(512);
  Received received(encode(array), 16 - header_size);
  const auto slice = received.read<Array<double>>();
  EXPECT_TRUE(received.holds(slice.data()));
  EXPECT_EQ(slice, array);
  EXPECT_EQ(received.decoder.copied_array_bytes(), 0);
}

TEST(ReceivedArray, KeepsTheMessageAlive) {
  Array<double> slice;
  {
    Received received(encode(counting(512)), 16 - header_size);
    slice = received.read<Array<double>>();
  }
  EXPECT_EQ(slice, counting(512));
}

TEST(ReceivedArray, IsCopiedWhenMisaligned) {
  const Array<double> array = counting(512);
  Received received(encode(array), 15 - header_size);
  const auto copy = received.read<Array<double>>();
  EXPECT_FALSE(received.holds(copy.data()));
  EXPECT_EQ(copy, array);
  EXPECT_EQ(received.decoder.copied_array_bytes(), 4096);
}

TEST(ReceivedArray, IsCopiedWhenSmall) {
  const Array<double> array = counting(511);
  Received received(encode(array), 16 - header_size);
  const auto copy = received.read<Array<double>>();
  EXPECT_FALSE(received.holds(copy.data()));
  EXPECT_EQ(received.decoder.copied_array_bytes(), 511 * 8);
}

TEST(ReceivedArray, OfBoolsIsASliceOnlyIfAllBytesAreRight) {
  std::vector<std::byte> bytes = encode(Array<bool>(5000));
  Received right(bytes, 0);
  EXPECT_TRUE(right.holds(right.read<Array<bool>>().data()));
  bytes.back() = std::byte{3};
  Received wrong(bytes, 0);
  const auto copy = wrong.read<Array<bool>>();
  EXPECT_FALSE(wrong.holds(copy.data()));
  EXPECT_TRUE(copy[4999]);
}

// Of a message whose items are elsewhere, as those of a slot in shared memory.
class DisplacedArray : public ::testing::Test {
 protected:
  // The items of the array of `received` move, and others are in their place.
  void displace(Received& received) {
    const std::span<const std::byte> gap = received.root.payload;
    std::memcpy(elsewhere_.bytes, gap.data(), gap.size());
    std::memset(const_cast<std::byte*>(gap.data()), 0x55, gap.size());
    displaced_ = {gap, elsewhere_.bytes};
    received.decoder.set_displaced({&displaced_, 1}, elsewhere_.owner);
  }
  [[nodiscard]] bool is_elsewhere(const void* data) const {
    return data >= elsewhere_.bytes && data < elsewhere_.bytes + 8192;
  }

  Allocation elsewhere_ = allocate(8192);
  DisplacedItems displaced_;
};

TEST_F(DisplacedArray, IsASliceOfWhereItIs) {
  const Array<double> array = counting(512);
  Received received(encode(array), 16 - header_size);
  displace(received);
  const auto slice = received.read<Array<double>>();
  EXPECT_TRUE(is_elsewhere(slice.data()));
  EXPECT_EQ(slice, array);
  EXPECT_FALSE(elsewhere_.owner.is_unique());
}

TEST_F(DisplacedArray, IsCopiedFromThereWhenSmallOrOfBools) {
  const Array<double> array = counting(511);
  Received received(encode(array), 16 - header_size);
  displace(received);
  const auto copy = received.read<Array<double>>();
  EXPECT_FALSE(is_elsewhere(copy.data()));
  EXPECT_EQ(copy, array);
  Array<bool> bools(5000);
  bools.mutate()[4999] = true;
  Received flags(encode(bools), 0);
  displace(flags);
  const auto copied = flags.read<Array<bool>>();
  EXPECT_FALSE(is_elsewhere(copied.data())) << "another process may change a byte to no bool";
  EXPECT_EQ(copied, bools);
}

TEST_F(DisplacedArray, BesideAnotherOneIsFoundByItsPlace) {
  const Array<double> array = counting(512);
  Received received(encode(array), 16 - header_size);
  displaced_ = {received.root.payload.first(4088), elsewhere_.bytes};
  received.decoder.set_displaced({&displaced_, 1}, elsewhere_.owner);
  const auto slice = received.read<Array<double>>();
  EXPECT_TRUE(received.holds(slice.data())) << "it is not all in the gap";
  EXPECT_EQ(slice, array);
}

TEST(ReceivedArray, OfNamedarraysIsASliceToo) {
  using conformance::types::Vector3;
  Array<Vector3> points(200);
  points.mutate()[199].z = 5;
  const std::vector<std::byte> bytes = encode(points);
  const std::size_t header = bytes.size() - 200 * sizeof(Vector3);
  Received received(bytes, (16 - header % 16) % 16);
  const auto slice = received.read<Array<Vector3>>();
  EXPECT_TRUE(received.holds(slice.data()));
  EXPECT_EQ(slice, points);
}

TEST(ReceivedArray, UsesTheMemoryOfTheOldValue) {
  const std::vector<std::byte> bytes = encode(Array<double>{4, 5, 6});
  Array<double> array{1, 2, 3};
  const double* before = array.data();
  decode(bytes, array);
  EXPECT_EQ(array.data(), before);
  EXPECT_EQ(array, (Array<double>{4, 5, 6}));
}

TEST(ReceivedArray, DoesNotWriteOverACopyOfTheOldValue) {
  const std::vector<std::byte> bytes = encode(Array<double>{4, 5, 6});
  Array<double> array{1, 2, 3};
  const Array<double> copy = array;
  decode(bytes, array);
  EXPECT_EQ(copy, (Array<double>{1, 2, 3}));
}

TEST(SentArray, IsAttachedWhenLarge) {
  const Array<double> array = counting(2048);
  Writer writer;
  encode(writer, array);
  const auto pieces = writer.pieces();
  ASSERT_EQ(pieces.size(), 2);
  EXPECT_EQ(static_cast<const void*>(pieces[1].data), array.data());
}

TEST(SentArray, IsKeptAliveByTheWriter) {
  Writer writer;
  encode(writer, counting(2048));
  EXPECT_EQ(decode<Array<double>>(writer.copy()), counting(2048));
}

TEST(MultiArray, HasTheBytesOfTheStandard) {
  const std::string dims = "04 64 69 6d 73 08 00";
  const std::string array = "0b 01 05 61 72 72 61 79 07 00 00";
  EXPECT_EQ(encode(MultiArray<std::int32_t>{{0}, {}}),
            from_hex("24 01" + value_name + "75 00 02 0e 01" + dims + "01 00 00 00 00" + array));
  EXPECT_EQ(encode(MultiArray<std::int32_t>{}),
            from_hex("20 01" + value_name + "75 00 02 0a 01" + dims + "00" + array));
}

ElementTree multi(const Array<std::uint32_t>& dims, const Array<double>& numbers) {
  return nested("value", ElementType::multidimarray, {},
                {numbers_of("dims", dims), numbers_of("array", numbers)});
}

TEST(MultiArray, DimsAreChecked) {
  EXPECT_EQ(error_of<MultiArray<double>>(multi({2, 2}, {1, 2, 3})), ErrorCode::data_type_error);
  EXPECT_EQ(error_of<MultiArray<double>>(multi({2, 2}, {1, 2, 3, 4})), ErrorCode::none);
  EXPECT_EQ(error_of<MultiArray<double>>(multi({}, {1})), ErrorCode::data_type_error);
  EXPECT_EQ(error_of<MultiArray<double>>(multi({}, {})), ErrorCode::none);
  EXPECT_EQ(error_of<MultiArray<double>>(multi({0x10000, 0x10000, 0x10000, 0x10000}, {})),
            ErrorCode::data_type_error);
  EXPECT_EQ(error_of<MultiArray<double>>(multi({0xFFFFFFFF, 0xFFFFFFFF, 0}, {})), ErrorCode::none);
}

TEST(MultiArray, FixedShapesAreChecked) {
  using Fixed = FixedMultiArray<double, 2, 1>;
  EXPECT_EQ(error_of<Fixed>(multi({2, 1}, {1, 2})), ErrorCode::none);
  EXPECT_EQ(error_of<Fixed>(multi({1, 2}, {1, 2})), ErrorCode::data_type_error);
  EXPECT_EQ(error_of<Fixed>(multi({2}, {1, 2})), ErrorCode::data_type_error);
  EXPECT_EQ(error_of<Fixed>(multi({2, 1}, {1})), ErrorCode::data_type_error);
}

TEST(MultiArray, FixedShapesOfLargeArraysAreCheckedBothWays) {
  const Type& type = type_of<FixedShape<double, 2, 1>>;
  MultiArray<double> array{{2, 1}, {1, 2}};
  Writer writer;
  type.write(writer, "value", &array);
  EXPECT_FALSE(writer.failed());
  const std::vector<std::byte> bytes = writer.copy();
  array.dims = {1, 2};
  writer.reset(MessageVersion::v4);
  type.write(writer, "value", &array);
  EXPECT_EQ(writer.code(), ErrorCode::data_type_error);

  Decoder decoder(MessageVersion::v4);
  ElementReader reader(decoder, bytes, 1);
  Element element;
  ASSERT_TRUE(reader.next(element));
  EXPECT_TRUE(type.read(decoder, element, &array));
  const Type& another = type_of<FixedShape<double, 1, 2>>;
  EXPECT_FALSE(another.read(decoder, element, &array));
  EXPECT_EQ(decoder.code(), ErrorCode::data_type_error);
}

TEST(MultiArray, PartsAreFoundByName) {
  const ElementTree dims = numbers_of<std::uint32_t>("dims", {1});
  const ElementTree array = numbers_of<double>("array", {4});
  const auto of = [](Elements elements) {
    return nested("value", ElementType::multidimarray, {}, std::move(elements));
  };
  EXPECT_EQ(value_of<MultiArray<double>>(of({array, dims})), (MultiArray<double>{{1}, {4}}));
  EXPECT_EQ(error_of<MultiArray<double>>(of({array})), ErrorCode::message_element_not_found);
  EXPECT_EQ(error_of<MultiArray<double>>(of({dims})), ErrorCode::message_element_not_found);
  EXPECT_EQ(error_of<MultiArray<double>>(of({numbers_of<std::int32_t>("dims", {1}), array})),
            ErrorCode::data_type_mismatch);
  EXPECT_EQ(error_of<MultiArray<float>>(of({dims, array})), ErrorCode::data_type_mismatch);
}

TEST(MultiArray, OfAWrongSizeIsNotSent) {
  EXPECT_EQ(sending_error_of(MultiArray<double>{{2, 2}, {1}}), ErrorCode::data_type_error);
  EXPECT_EQ(sending_error_of(MultiArray<double>{{}, {1}}), ErrorCode::data_type_error);
}

}  // namespace
}  // namespace rr::testing_values
