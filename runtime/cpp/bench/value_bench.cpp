// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "rr/codec.hpp"
#include "rr/type.hpp"

// Typed values to bytes and back: a struct of 20 fields, a list of 10,000 of them, and an array of
// 10,000 poses. The types are as generated code has them.
namespace bench_types {

extern const rr::RecordType rr_S20;
extern const rr::RecordType rr_S20List;
extern const rr::RecordType rr_Pose;
extern const rr::RecordType rr_PoseList;

struct S20 {
  std::int32_t i1 = 0;
  std::int32_t i2 = 0;
  std::int32_t i3 = 0;
  std::uint32_t u1 = 0;
  std::uint32_t u2 = 0;
  std::int64_t l1 = 0;
  std::int64_t l2 = 0;
  double d1 = 0;
  double d2 = 0;
  double d3 = 0;
  double d4 = 0;
  double d5 = 0;
  double d6 = 0;
  float f1 = 0;
  float f2 = 0;
  bool b1 = false;
  std::string name;
  std::string frame;
  rr::Array<double> joints;
  rr::Array<std::uint8_t> digest;

  bool operator==(const S20&) const = default;
};
struct S20List {
  std::optional<std::vector<std::optional<S20>>> items;

  bool operator==(const S20List&) const = default;
};
struct Pose {
  double x = 0;
  double y = 0;
  double z = 0;
  double qw = 0;
  double qx = 0;
  double qy = 0;
  double qz = 0;

  bool operator==(const Pose&) const = default;
};
struct PoseList {
  rr::Array<Pose> items;

  bool operator==(const PoseList&) const = default;
};

}  // namespace bench_types

template <>
inline constexpr const rr::Type& rr::type_of<bench_types::S20> = bench_types::rr_S20;
template <>
inline constexpr const rr::Type& rr::type_of<bench_types::S20List> = bench_types::rr_S20List;
template <>
inline constexpr const rr::Type& rr::type_of<bench_types::Pose> = bench_types::rr_Pose;
template <>
inline constexpr const rr::Type& rr::type_of<bench_types::PoseList> = bench_types::rr_PoseList;

namespace bench_types {
namespace {

constexpr rr::Field s20_fields[] = {
    rr::field<std::int32_t>("i1", offsetof(S20, i1)),
    rr::field<std::int32_t>("i2", offsetof(S20, i2)),
    rr::field<std::int32_t>("i3", offsetof(S20, i3)),
    rr::field<std::uint32_t>("u1", offsetof(S20, u1)),
    rr::field<std::uint32_t>("u2", offsetof(S20, u2)),
    rr::field<std::int64_t>("l1", offsetof(S20, l1)),
    rr::field<std::int64_t>("l2", offsetof(S20, l2)),
    rr::field<double>("d1", offsetof(S20, d1)),
    rr::field<double>("d2", offsetof(S20, d2)),
    rr::field<double>("d3", offsetof(S20, d3)),
    rr::field<double>("d4", offsetof(S20, d4)),
    rr::field<double>("d5", offsetof(S20, d5)),
    rr::field<double>("d6", offsetof(S20, d6)),
    rr::field<float>("f1", offsetof(S20, f1)),
    rr::field<float>("f2", offsetof(S20, f2)),
    rr::field<bool>("b1", offsetof(S20, b1)),
    rr::field<std::string>("name", offsetof(S20, name)),
    rr::field<std::string>("frame", offsetof(S20, frame)),
    rr::field<rr::Array<double>>("joints", offsetof(S20, joints)),
    rr::field<rr::Array<std::uint8_t>>("digest", offsetof(S20, digest)),
};
constexpr rr::Field s20_list_fields[] = {
    rr::field<std::optional<std::vector<std::optional<S20>>>>("items", offsetof(S20List, items)),
};
constexpr rr::Field pose_list_fields[] = {
    rr::field<rr::Array<Pose>>("items", offsetof(PoseList, items)),
};

}  // namespace

constinit const rr::RecordType rr_S20{rr::RecordKind::struct_, "bench.wire.S20", s20_fields,
                                      rr::record_operations<S20>};
constinit const rr::RecordType rr_S20List{rr::RecordKind::struct_, "bench.wire.S20List",
                                          s20_list_fields, rr::record_operations<S20List>};
constinit const rr::RecordType rr_Pose{"bench.wire.Pose", rr::ElementType::double_, 7,
                                       rr::record_operations<Pose>};
constinit const rr::RecordType rr_PoseList{rr::RecordKind::struct_, "bench.wire.PoseList",
                                           pose_list_fields, rr::record_operations<PoseList>};

namespace {

constexpr int list_size = 10000;

S20 make_s20(int k) {
  S20 s;
  s.i1 = k;
  s.i2 = -k;
  s.i3 = 1000000 + k;
  s.u1 = 7U * static_cast<std::uint32_t>(k);
  s.u2 = 4000000000U;
  s.l1 = 1700000000000000000 + k;
  s.l2 = -k;
  s.d1 = 0.1 * k;
  s.d2 = 1.0 / (k + 1);
  s.d3 = 3.25;
  s.d4 = -2.5e-3 * k;
  s.d5 = 1e9;
  s.d6 = k;
  s.f1 = 0.5F * static_cast<float>(k);
  s.f2 = 2.5F;
  s.b1 = (k & 1) != 0;
  s.name = "joint_" + std::to_string(k % 100);
  s.frame = "robot_base_link_frame";
  s.joints = {0.1 * k, 0.2, 0.3, 0.4, 0.5, 0.6};
  s.digest = rr::Array<std::uint8_t>(16);
  return s;
}
S20List make_list() {
  S20List list;
  list.items.emplace();
  for (int k = 0; k < list_size; ++k) list.items->emplace_back(make_s20(k));
  return list;
}
PoseList make_poses() {
  PoseList list;
  list.items = rr::Array<Pose>(list_size);
  double x = 0;
  for (Pose& pose : list.items.mutate()) pose = {x++, 1, 2, 1, 0, 0, 0.5};
  return list;
}

template <class T>
void encode(benchmark::State& state, const T& value) {
  rr::Writer writer;
  for (auto _ : state) {
    rr::encode(writer, value);
    benchmark::DoNotOptimize(writer.size());
  }
  state.counters["bytes"] = static_cast<double>(writer.size());
}
// Into a new value each time, as a call returns one.
template <class T>
void decode(benchmark::State& state, const T& value) {
  const std::vector<std::byte> bytes = rr::encode(value);
  for (auto _ : state) benchmark::DoNotOptimize(rr::decode<T>(bytes));
}
// Into the same value, as a stream of packets does.
template <class T>
void decode_again(benchmark::State& state, const T& value) {
  const std::vector<std::byte> bytes = rr::encode(value);
  T into;
  for (auto _ : state) {
    rr::decode(bytes, into);
    benchmark::DoNotOptimize(into);
  }
}
// From memory that large arrays may be slices of, as a connection receives it.
template <class T>
void decode_sliced(benchmark::State& state, const T& value) {
  const std::vector<std::byte> encoded = rr::encode(value);
  // The message header before it moves the payload; here it is moved until it is aligned.
  std::size_t shift = 0;
  while (shift < 8) {
    const rr::Allocation memory = rr::allocate(encoded.size() + shift);
    std::memcpy(memory.bytes + shift, encoded.data(), encoded.size());
    const std::span<const std::byte> bytes(memory.bytes + shift, encoded.size());
    T probe;
    rr::decode(bytes, probe, rr::MessageVersion::v4, nullptr, memory.owner);
    const auto* items = reinterpret_cast<const std::byte*>(probe.items.data());
    if (items >= memory.bytes && items < memory.bytes + encoded.size()) break;
    ++shift;
  }
  const rr::Allocation memory = rr::allocate(encoded.size() + shift);
  std::memcpy(memory.bytes + shift, encoded.data(), encoded.size());
  for (auto _ : state) {
    T into;
    rr::decode(std::span<const std::byte>(memory.bytes + shift, encoded.size()), into,
               rr::MessageVersion::v4, nullptr, memory.owner);
    benchmark::DoNotOptimize(into);
  }
}

void struct20_encode(benchmark::State& state) { encode(state, make_s20(3)); }
void struct20_decode(benchmark::State& state) { decode(state, make_s20(3)); }
void struct20_decode_again(benchmark::State& state) { decode_again(state, make_s20(3)); }
void list10k_encode(benchmark::State& state) { encode(state, make_list()); }
void list10k_decode(benchmark::State& state) { decode(state, make_list()); }
void list10k_decode_again(benchmark::State& state) { decode_again(state, make_list()); }
void pose10k_encode(benchmark::State& state) { encode(state, make_poses()); }
void pose10k_decode(benchmark::State& state) { decode(state, make_poses()); }
void pose10k_decode_again(benchmark::State& state) { decode_again(state, make_poses()); }
void pose10k_decode_sliced(benchmark::State& state) { decode_sliced(state, make_poses()); }

BENCHMARK(struct20_encode);
BENCHMARK(struct20_decode);
BENCHMARK(struct20_decode_again);
BENCHMARK(list10k_encode);
BENCHMARK(list10k_decode);
BENCHMARK(list10k_decode_again);
BENCHMARK(pose10k_encode);
BENCHMARK(pose10k_decode);
BENCHMARK(pose10k_decode_again);
BENCHMARK(pose10k_decode_sliced);

}  // namespace
}  // namespace bench_types
