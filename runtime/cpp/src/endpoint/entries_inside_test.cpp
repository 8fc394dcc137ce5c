// SPDX-License-Identifier: Apache-2.0
// What entries say: values, errors, answers, packets of wires and pipes.
#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "rr/error.hpp"
#include "rr/reader.hpp"
#include "rr/type.hpp"
#include "rr/writer.hpp"
#include "runtime/cpp/src/endpoint/errors.hpp"
#include "runtime/cpp/src/endpoint/pipe_arrival.hpp"
#include "runtime/cpp/src/endpoint/pipe_packets.hpp"
#include "runtime/cpp/src/endpoint/requests.hpp"
#include "runtime/cpp/src/endpoint/values.hpp"
#include "runtime/cpp/src/endpoint/wire_values.hpp"

namespace rr::endpoint {
namespace {

// A message of one entry that has come.
class Received {
 public:
  // What `write` writes returns the number of elements.
  template <class Write>
  explicit Received(const EntryHeader& header, const Write& write) {
    Writer writer;
    writer.reset(MessageVersion::v4);
    const std::size_t end = writer.position();
    const std::uint32_t count = write(writer);
    writer.entry(header, count, end);
    finish(writer);
  }
  // An entry that is written whole.
  template <class Write>
  static Received whole(const Write& write) {
    Writer writer;
    writer.reset(MessageVersion::v4);
    write(writer);
    return Received(writer);
  }
  Decoder decoder() { return Decoder(message.version, &message.strings, {}, &types); }

  TypeRegistry types;
  Message message;
  Entry entry;

 private:
  explicit Received(Writer& writer) { finish(writer); }
  void finish(Writer& writer) {
    writer.message({}, 1);
    bytes_ = writer.copy();
    EXPECT_TRUE(read_message(bytes_, {}, false, message, entry));
  }
  std::vector<std::byte> bytes_;
};

constexpr EntryHeader header{
    .type = EntryType::function_call_req, .service_path = "arm", .member = "move", .request_id = 7};
constexpr Parameter parameters[] = {{"x", &type_of<double>}, {"name", &type_of<std::string>}};

std::uint32_t write_both(Writer& writer) {
  const double x = 2.5;
  const std::string name = "tool";
  const void* const values[] = {&x, &name};
  write_values(writer, parameters, values);
  return 2;
}

TEST(Values, AreReadAsTheyWereWritten) {
  Received received(header, write_both);
  Decoder decoder = received.decoder();
  double x = 0;
  std::string name;
  void* const places[] = {&x, &name};
  read_values(decoder, received.entry, parameters, places);
  EXPECT_EQ(x, 2.5);
  EXPECT_EQ(name, "tool");
  const Parameter swapped[] = {parameters[1], parameters[0]};
  void* const other[] = {&name, &x};
  x = 0;
  read_values(decoder, received.entry, swapped, other);
  EXPECT_EQ(x, 2.5) << "in any order";
}

TEST(Values, OneThatIsMissingOrOfAnotherTypeIsAnError) {
  Received received(header, write_both);
  const auto code = [&](std::string_view name, const Type& type) {
    Decoder decoder = received.decoder();
    VarValue value;
    double number = 0;
    std::string text;
    void* const place = &type == &type_of<double> ? static_cast<void*>(&number) : &text;
    try {
      read_value(decoder, received.entry, name, type, place);
    } catch (const Error& error) {
      return error.code();
    }
    return ErrorCode::none;
  };
  EXPECT_EQ(code("x", type_of<double>), ErrorCode::none);
  EXPECT_EQ(code("y", type_of<double>), ErrorCode::message_element_not_found);
  EXPECT_EQ(code("x", type_of<std::string>), ErrorCode::data_type_mismatch);
}

TEST(Values, ATextIsFoundByItsName) {
  Received received(header, write_both);
  Decoder decoder = received.decoder();
  std::string_view text;
  EXPECT_TRUE(find_text(decoder, received.entry, "name", text));
  EXPECT_EQ(text, "tool");
  EXPECT_FALSE(find_text(decoder, received.entry, "x", text)) << "a number";
  EXPECT_FALSE(find_text(decoder, received.entry, "none", text));
}

TEST(Requests, AnAnswerSaysAgainWhatWasAsked) {
  Entry request;
  static_cast<EntryHeader&>(request) = header;
  const EntryHeader answer = answer_header(request, ErrorCode::service_error);
  EXPECT_EQ(answer.type, EntryType::function_call_res);
  EXPECT_EQ(answer.service_path, "arm");
  EXPECT_EQ(answer.member, "move");
  EXPECT_EQ(answer.request_id, 7U);
  EXPECT_EQ(answer.error, static_cast<std::uint16_t>(ErrorCode::service_error));
  const Received empty =
      Received::whole([&](Writer& writer) { write_empty_answer(writer, request); });
  EXPECT_EQ(empty.entry.type, EntryType::function_call_res);
  EXPECT_EQ(empty.entry.element_count, 0U);
  EXPECT_EQ(empty.entry.error, 0U);
  Received capability =
      Received::whole([&](Writer& writer) { write_capability_answer(writer, request); });
  Decoder decoder = capability.decoder();
  std::uint32_t level = 5;
  read_value(decoder, capability.entry, "return", type_of<std::uint32_t>, &level);
  EXPECT_EQ(level, 0U);
}

TEST(Requests, SomeKeepTheirPlace) {
  using channel::Priority;
  EXPECT_EQ(priority_of(EntryType::function_call_req, false), Priority::usual);
  EXPECT_EQ(priority_of(EntryType::function_call_req, true), Priority::urgent);
  EXPECT_EQ(priority_of(EntryType::client_session_op_req, true), Priority::fixed);
  EXPECT_EQ(priority_of(EntryType::service_path_released_req, true), Priority::fixed);
  EXPECT_EQ(priority_of(EntryType::connect_client, false), Priority::fixed);
}

Error read_back(const Error& error) {
  Entry request;
  static_cast<EntryHeader&>(request) = header;
  Received received =
      Received::whole([&](Writer& writer) { write_error_answer(writer, request, error); });
  try {
    std::rethrow_exception(read_error(received.message, received.entry, {}, received.types));
  } catch (const Error& read) {
    return read;
  }
}

TEST(Errors, TravelWithTheirNamesAndParameters) {
  const Error read = read_back(Error(ErrorCode::remote_error, "test.TooHot", "47 degrees", "arm",
                                     VarValue(std::string("joint 3"))));
  EXPECT_EQ(read.code(), ErrorCode::remote_error);
  EXPECT_EQ(read.name(), "test.TooHot");
  EXPECT_EQ(read.message(), "47 degrees");
  EXPECT_EQ(read.subname(), "arm");
  EXPECT_FALSE(read.parameter().is_null());
  const Error known = read_back(Error(ErrorCode::invalid_argument, "my.name", "why"));
  EXPECT_EQ(known.name(), error_name(ErrorCode::invalid_argument)) << "known by its code";
  EXPECT_TRUE(known.parameter().is_null());
}

TEST(Errors, SaySomethingOfEachException) {
  const auto described = [](const std::exception_ptr& thrown) { return describe(thrown); };
  const auto error = [&](ErrorCode code) {
    return described(std::make_exception_ptr(Error(code, "why")));
  };
  EXPECT_EQ(error(ErrorCode::invalid_argument).code(), ErrorCode::invalid_argument);
  EXPECT_EQ(error(ErrorCode::none).code(), ErrorCode::unknown_error);
  const Error standard = described(std::make_exception_ptr(std::runtime_error("why")));
  EXPECT_EQ(standard.message(), "why");
  EXPECT_EQ(standard.code(), ErrorCode::remote_error);
  EXPECT_EQ(described(std::make_exception_ptr(7)).message(), "an exception of an unknown type");
  Writer writer;
  writer.reset(MessageVersion::v4);
  write_error(writer, Error(ErrorCode::service_error, "why"));
  EXPECT_FALSE(writer.failed());
}

TEST(Errors, ADecodersIsThatOfItsValue) {
  Received received(header, write_both);
  Decoder decoder = received.decoder();
  Element element;
  ASSERT_TRUE(
      find_element(decoder, received.entry.elements, received.entry.element_count, "x", element));
  std::string text;
  EXPECT_FALSE(type_of<std::string>.read(decoder, element, &text));
  EXPECT_EQ(latched(decoder).code(), ErrorCode::data_type_mismatch);
}

TEST(WireValues, HaveATimeThatIsSound) {
  using Seconds = std::numeric_limits<std::int64_t>;
  const auto read = [](TimeSpec written) {
    Received received({.type = EntryType::wire_packet}, [&](Writer& writer) {
      const double value = 1.5;
      write_wire_value(writer, type_of<double>, &value);
      write_wire_time(writer, written);
      return wire_elements;
    });
    TimeSpec time;
    double value = 0;
    read_wire(received.message, received.entry, {}, received.types, type_of<double>, time, &value);
    EXPECT_EQ(value, 1.5);
    Decoder decoder = received.decoder();
    TimeSpec again;
    read_wire(decoder, received.entry, type_of<double>, again, &value);
    EXPECT_EQ(again, time);
    return time;
  };
  EXPECT_EQ(read({5, 6}), (TimeSpec{5, 6}));
  EXPECT_EQ(read({5, 1'000'000'006}), (TimeSpec{6, 6}));
  EXPECT_EQ(read({5, -1}), (TimeSpec{4, 999'999'999}));
  EXPECT_EQ(read({Seconds::max(), 2'000'000'000}), (TimeSpec{Seconds::max(), 999'999'999}));
  EXPECT_EQ(read({Seconds::min(), -1}), (TimeSpec{Seconds::min(), 0}));
}

TEST(PipePackets, AreReadOneByOne) {
  Received received({.type = EntryType::pipe_packet}, [](Writer& writer) {
    const double second = 2;
    write_packet(writer, "5", 8, true, [&] { type_of<double>.write(writer, "packet", &second); });
    const std::string text = "no packet";
    type_of<std::string>.write(writer, "other", &text);
    const double first = 1;
    write_packet(writer, "4", 7, false, [&] { type_of<double>.write(writer, "packet", &first); });
    return 3U;
  });
  Decoder decoder = received.decoder();
  PipePacketReader reader(decoder, received.entry);
  PipePacket packet;
  double value = 0;
  ASSERT_TRUE(reader.next(packet));
  EXPECT_EQ(packet.index, 4);
  EXPECT_EQ(packet.number, 7U);
  EXPECT_FALSE(packet.asks_acknowledgement);
  EXPECT_TRUE(type_of<double>.read(decoder, packet.value, &value));
  EXPECT_EQ(value, 1);
  ASSERT_TRUE(reader.next(packet));
  EXPECT_EQ(packet.index, 5);
  EXPECT_EQ(packet.number, 8U);
  EXPECT_TRUE(packet.asks_acknowledgement);
  EXPECT_FALSE(reader.next(packet));
}

TEST(PipePackets, AcknowledgementsAreReadOneByOne) {
  Received received({.type = EntryType::pipe_packet_ret}, [](Writer& writer) {
    write_acknowledgement(writer, 5, 9);
    write_acknowledgement(writer, -1, 8);
    return 2U;
  });
  std::vector<std::pair<std::int32_t, std::uint32_t>> found;
  for_each_acknowledgement(
      received.message, received.entry,
      [&](std::int32_t index, std::uint32_t number) { found.emplace_back(index, number); });
  EXPECT_EQ(found, (decltype(found){{-1, 8}, {5, 9}}));
}

}  // namespace
}  // namespace rr::endpoint
