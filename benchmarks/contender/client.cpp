// SPDX-License-Identifier: Apache-2.0
// The runtime as a contender of the wire benchmark: its client.
#include <array>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench.hpp"
#include "bench/wire.hpp"
#include "rr/async.hpp"
#include "rr/codec.hpp"
#include "rr/node.hpp"

namespace {

namespace wire = bench::wire;

class Session final : public bench::Session {
 public:
  Session(rr::Node& node, int port)
      : client_(node.connect<wire::BenchStub>("rr+tcp://127.0.0.1:" + std::to_string(port) +
                                              "/?service=bench")) {}

  double get() override { return client_->get_value(); }

  void call(const std::string& s, const double* in, double* out) override {
    std::array<double, 16> a;
    std::memcpy(a.data(), in, sizeof a);
    const auto result = client_->call(s, a);
    std::memcpy(out, result.data(), sizeof result);
  }

  void blob(std::uint32_t n) override {
    const auto bytes = client_->blob(n);
    bench::check_blob(bytes.data(), bytes.size(), n);
  }

  wire::BenchStub& stub() { return *client_; }

 private:
  rr::Client<wire::BenchStub> client_;
};

void fill(wire::S20& to, const bench::S20& from) {
  to.i1 = from.i1;
  to.i2 = from.i2;
  to.i3 = from.i3;
  to.u1 = from.u1;
  to.u2 = from.u2;
  to.l1 = from.l1;
  to.l2 = from.l2;
  to.d1 = from.d1;
  to.d2 = from.d2;
  to.d3 = from.d3;
  to.d4 = from.d4;
  to.d5 = from.d5;
  to.d6 = from.d6;
  to.f1 = from.f1;
  to.f2 = from.f2;
  to.b1 = from.b1;
  to.name = from.name;
  to.frame = from.frame;
  to.joints = from.joints;
  to.digest = from.digest;
}

double check(const wire::S20& s) {
  double sum = s.i1 + 2.0 * s.i2 + s.i3 + s.u1 + s.u2 + static_cast<double>(s.l1 & 0xffff) +
               static_cast<double>(s.l2) + s.d1 + s.d2 + s.d3 + s.d4 + s.d5 + s.d6 +
               static_cast<double>(s.f1) + static_cast<double>(s.f2) + (s.b1 ? 1 : 0) +
               static_cast<double>(s.name.size() + s.frame.size()) + s.name[0] + s.frame[0];
  for (const double value : s.joints) sum += value;
  for (const std::uint8_t value : s.digest) sum += value;
  return sum;
}

double check(const wire::Pose& p) { return p.x + p.y + p.z + p.qw + p.qx + p.qy + p.qz; }

class Client final : public bench::Client {
 public:
  std::unique_ptr<bench::Session> connect(int port, int) override {
    return std::make_unique<Session>(node_, port);
  }

  // Callers of L3 share a connection, as those of Ice and gRPC do; with ROBDEF_BENCH_SEPARATE=1
  // they have one each, as those of omniORB and Thrift.
  bool shared_session() override { return std::getenv("ROBDEF_BENCH_SEPARATE") == nullptr; }

  void async(int port, bench::AsyncRun& run) override {
    Session session(node_, port);
    std::atomic<int> live{run.outstanding};
    struct Issue {
      Session& session;
      bench::AsyncRun& run;
      std::atomic<int>& live;
      void operator()() const {
        session.stub().async_get_value([*this](std::exception_ptr error, double) {
          if (error != nullptr) std::abort();
          if (run.complete()) {
            (*this)();
          } else {
            --live;
          }
        });
      }
    };
    for (int i = 0; i < run.outstanding; ++i) Issue{session, run, live}();
    while (live != 0) bench::sleep_s(0.01);
  }

  void stream(int port, bench::StreamRun& run) override {
    std::vector<std::unique_ptr<Session>> sessions;
    std::vector<rr::Subscription> subscriptions;
    for (int i = 0; i < run.subs; ++i) {
      auto& session = *sessions.emplace_back(std::make_unique<Session>(node_, port));
      bench::StreamSink& sink = *run.sinks[static_cast<std::size_t>(i)];
      auto end = session.stub().states().connect();
      subscriptions.push_back(end.on_packet([&sink](const std::optional<wire::JointState>& state) {
        sink.on_packet(state->t_ns, state->q[0]);
      }));
    }
    for (const auto& session : sessions) {
      session->stub().subscribe(run.packets, run.rate, static_cast<std::uint32_t>(run.subs), false);
    }
    run.wait();
  }

  void codec(bench::CodecRun& run) override {
    const bench::S20 one = bench::make_s20(3);
    measure<wire::S20>(
        run, "struct20", bench::check(one), [&](wire::S20& value) { fill(value, one); },
        [](const wire::S20& value) { return check(value); });

    std::vector<bench::S20> structs;
    std::vector<bench::Pose> poses;
    double structs_check = 0;
    double poses_check = 0;
    for (int i = 0; i < 10000; ++i) {
      structs.push_back(bench::make_s20(i));
      structs_check += bench::check(structs.back());
      poses.push_back(bench::make_pose(i));
      poses_check += bench::check(poses.back());
    }
    measure<wire::S20List>(
        run, "list10k", structs_check,
        [&](wire::S20List& value) {
          auto& items = value.items.emplace(structs.size());
          for (std::size_t i = 0; i < structs.size(); ++i) fill(items[i].emplace(), structs[i]);
        },
        [](const wire::S20List& value) {
          double sum = 0;
          for (const auto& item : *value.items) sum += check(*item);
          return sum;
        });
    measure<wire::PoseList>(
        run, "pose10k", poses_check,
        [&](wire::PoseList& value) {
          value.items = rr::Array<wire::Pose>(poses.size());
          std::memcpy(value.items.mutate().data(), poses.data(), poses.size() * sizeof(wire::Pose));
        },
        [](const wire::PoseList& value) {
          double sum = 0;
          for (const auto& item : value.items) sum += check(item);
          return sum;
        });
  }

 private:
  template <class T, class Fill, class Read>
  void measure(bench::CodecRun& run, const char* name, double wanted, Fill fill_value, Read read) {
    rr::Writer writer;
    std::vector<std::byte> bytes;
    run.measure(
        name, wanted,
        [&] {
          T value;
          fill_value(value);
          rr::encode(writer, value);
          if (bytes.empty()) bytes = writer.copy();
          return writer.size();
        },
        [&] {
          T value;
          rr::decode(bytes, value);
          return read(value);
        });
  }

  rr::Node node_;
};

}  // namespace

int main(int argc, char** argv) {
  return bench::client_main(argc, argv,
                            [](const bench::Args&) { return std::make_unique<Client>(); });
}
