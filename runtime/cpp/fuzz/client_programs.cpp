// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/fuzz/client_programs.hpp"

#include <array>
#include <boost/asio/use_future.hpp>
#include <experimental/fuzzed.hpp>
#include <string>
#include <utility>
#include <vector>

#include "rr/async.hpp"
#include "rr/call.hpp"
#include "rr/locks.hpp"

namespace rr::fuzz {
namespace {

namespace robdef = ::experimental::fuzzed;
using boost::asio::use_future;
using namespace std::chrono_literals;

// What is waited for that may never come.
constexpr std::chrono::milliseconds a_moment{1};

using Use = void(Client<robdef::RootStub>& root, Attempts& attempts);

template <Use* use>
void with_client(Node& node, std::string_view url, Attempts& attempts) {
  Client<robdef::RootStub> client;
  const bool is_connected = attempts.attempt([&] {
    ConnectOptions options;
    options.on_closed = [](const Error&) {};
    options.on_path_released = [](const std::string&) {};
    client = node.connect<robdef::RootStub>(url, std::move(options));
  });
  if (!is_connected) return;
  attempts.watch(client);
  use(client, attempts);
  attempts.attempt([&] { client.close(); });
}

template <class S, class... Getters>
void get_all(S& stub, Attempts& attempts, Getters... getters) {
  (attempts.attempt([&] { static_cast<void>((stub.*getters)()); }), ...);
}

void get_numbers(Client<robdef::RootStub>& root, Attempts& attempts) {
  using P = robdef::PropertyBoardStub;
  std::shared_ptr<P> props;
  if (!attempts.attempt([&] { props = root->get_props(); })) return;
  get_all(*props, attempts, &P::get_v_double, &P::get_v_int8, &P::get_v_uint64, &P::get_v_bool,
          &P::get_v_cdouble, &P::get_v_string, &P::get_v_mode, &P::get_a_double, &P::get_a_uint8,
          &P::get_a_bool, &P::get_a_cdouble, &P::get_f_double, &P::get_f_bool, &P::get_x_int32,
          &P::get_m_double, &P::get_m_bool, &P::get_g_single, &P::get_ro_value, &P::get_pc_value,
          &P::get_ur_value, &P::get_failing);
  attempts.attempt([&] { props->set_v_double(0.5); });
  attempts.attempt([&] { props->set_failing(1); });
  attempts.attempt([&] { props->set_a_int64({1, 2, 3}); });
}

void get_containers(Client<robdef::RootStub>& root, Attempts& attempts) {
  using P = robdef::PropertyBoardStub;
  std::shared_ptr<P> props;
  if (!attempts.attempt([&] { props = root->get_props(); })) return;
  robdef::Tree tree;
  tree.name = "tree";
  tree.leaves = {robdef::Leaf{"leaf", robdef::Mode::idle, robdef::Stats{1, 2, "three"}}};
  tree.by_name = {{"one", std::nullopt}};
  tree.extra = VarValue(1.5);
  attempts.attempt([&] { props->set_t_tree(tree); });
  attempts.attempt([&] { props->set_l_double(std::vector<double>{1, 2}); });
  attempts.attempt([&] { props->set_any(VarValue(robdef::Stats{1, 2, "any"})); });
  attempts.attempt([&] {
    props->set_l_any(std::vector<VarValue>{VarValue(1.5), VarValue("two")});
  });
  get_all(*props, attempts, &P::get_t_tree, &P::get_l_double, &P::get_any, &P::get_l_any,
          &P::get_l_bool, &P::get_i_bool, &P::get_l_string, &P::get_l_array, &P::get_l_multidim,
          &P::get_l_mode, &P::get_l_stats, &P::get_i_double, &P::get_i_array, &P::get_s_double,
          &P::get_s_array, &P::get_s_stats, &P::get_t_stats, &P::get_i_any, &P::get_s_any);
}

void get_records(Client<robdef::RootStub>& root, Attempts& attempts) {
  using P = robdef::PropertyBoardStub;
  std::shared_ptr<P> props;
  if (!attempts.attempt([&] { props = root->get_props(); })) return;
  attempts.attempt([&] { props->set_p_array({robdef::Sample{}, robdef::Sample{}}); });
  attempts.attempt([&] { props->set_n_array({robdef::Vector3{1, 2, 3}}); });
  get_all(*props, attempts, &P::get_p_one, &P::get_p_array, &P::get_p_fixed, &P::get_p_max,
          &P::get_p_multidim, &P::get_p_grid, &P::get_p_list_array, &P::get_p_map,
          &P::get_p_reading, &P::get_n_one, &P::get_n_array, &P::get_n_fixed, &P::get_n_max,
          &P::get_n_multidim, &P::get_n_grid, &P::get_n_map_array, &P::get_n_transform,
          &P::get_n_image);
}

void call_functions(Client<robdef::RootStub>& root, Attempts& attempts) {
  std::shared_ptr<robdef::FunctionBoardStub> funcs;
  if (!attempts.attempt([&] { funcs = root->get_funcs(); })) return;
  const robdef::Leaf leaf{"leaf", robdef::Mode::remote, robdef::Stats{1, 2, "three"}};
  attempts.attempt([&] { funcs->nothing(); });
  attempts.attempt([&] { static_cast<void>(funcs->add(1, 2)); });
  attempts.attempt([&] { static_cast<void>(funcs->join("a", "b", "c")); });
  attempts.attempt([&] { static_cast<void>(funcs->five(1, 2, 3, {4}, "five")); });
  attempts.attempt([&] { static_cast<void>(funcs->make_stats(1, 2, "three")); });
  attempts.attempt([&] { static_cast<void>(funcs->echo_leaf(leaf)); });
  attempts.attempt([&] { static_cast<void>(funcs->echo_trees({{robdef::Tree{}}})); });
  attempts.attempt([&] { static_cast<void>(funcs->cross({1, 2, 3}, {4, 5, 6})); });
  attempts.attempt([&] { static_cast<void>(funcs->echo_samples({robdef::Sample{}})); });
  attempts.attempt([&] { static_cast<void>(funcs->echo_any(VarValue(leaf))); });
  attempts.attempt([&] { static_cast<void>(funcs->next_mode(robdef::Mode::faulted)); });
  attempts.attempt_async([&] { return funcs->async_nothing(use_future); });
  attempts.attempt_async([&] { return funcs->async_add(1, 2, use_future); });
  attempts.attempt_async([&] { return funcs->async_echo_leaf(leaf, use_future); });
  attempts.attempt_async([&] { return root->async_get_child(use_future); });
  attempts.attempt_async([&] { return root->async_get_title(use_future); });
}

void take_errors(Client<robdef::RootStub>& root, Attempts& attempts) {
  std::shared_ptr<robdef::ErrorBoardStub> errs;
  if (!attempts.attempt([&] { errs = root->get_errs(); })) return;
  attempts.attempt([&] { errs->raise_service_fault("fault"); });
  attempts.attempt([&] { errs->raise_calibration_error("error", "subname", VarValue(2.5)); });
  attempts.attempt([&] { errs->raise_unknown_name("unknown"); });
  attempts.attempt([&] { errs->raise_code(7, "code"); });
  attempts.attempt([&] { errs->raise_native("native"); });
  attempts.attempt([&] { static_cast<void>(errs->get_failing_value()); });
  attempts.attempt_async([&] { return errs->async_raise_probe_fault("fault", use_future); });
}

void find_objects(Client<robdef::RootStub>& root, Attempts& attempts) {
  attempts.attempt([&] { static_cast<void>(root->get_child()->get_next_child()->add(1, 2)); });
  attempts.attempt([&] { static_cast<void>(root->get_by_index(1)->get_number()); });
  attempts.attempt([&] { static_cast<void>(root->get_by_index(9)); });
  attempts.attempt([&] { static_cast<void>(root->get_by_number(0)); });
  attempts.attempt([&] { static_cast<void>(root->get_by_name("a b")->describe()); });
  attempts.attempt([&] { static_cast<void>(root->get_any_named("c")->describe()); });
  attempts.attempt([&] { static_cast<void>(root->get_anything()); });
  attempts.attempt([&] { static_cast<void>(root->get_anything_by_number(3)); });
  attempts.attempt([&] { root->release_child("child"); });
  attempts.attempt([&] { static_cast<void>(root->get_child()); });
}

void take_events(Client<robdef::RootStub>& root, Attempts& attempts) {
  std::shared_ptr<robdef::EventBoardStub> events;
  if (!attempts.attempt([&] { events = root->get_events(); })) return;
  std::vector<Subscription> handlers;
  const auto listen = [&](const auto& connect) {
    attempts.attempt([&] { handlers.push_back(connect()); });
  };
  listen([&] { return events->tick().connect([] {}); });
  listen([&] { return events->value_changed().connect([](double) {}); });
  listen([&] {
    return events->many().connect([](std::int32_t, const std::string&, const Array<double>&,
                                     const std::optional<robdef::Stats>&, const robdef::Vector3&,
                                     const robdef::Sample&, const VarValue&,
                                     const std::optional<std::vector<robdef::Mode>>&) {});
  });
  listen([&] { return events->hurry_tick().connect([](std::int32_t) {}); });
  attempts.attempt([&] { events->fire_tick(); });
  attempts.attempt([&] { events->fire_value_changed(); });
  attempts.attempt([&] { events->fire_many(); });
  attempts.attempt([&] { events->fire_given({1, 2}, VarValue("given")); });
}

void use_pipes(Client<robdef::RootStub>& root, Attempts& attempts) {
  std::shared_ptr<robdef::StreamBoardStub> streams;
  if (!attempts.attempt([&] { streams = root->get_streams(); })) return;
  PipeEndpoint<Array<double>> samples;
  PipeEndpoint<std::optional<robdef::Leaf>> leaves;
  PipeEndpoint<VarValue> parcels;
  const bool has_samples = attempts.attempt([&] { samples = streams->samples().connect({}); });
  const bool has_leaves = attempts.attempt([&] { leaves = streams->leaves().connect({}); });
  const bool has_parcels = attempts.attempt([&] { parcels = streams->parcels().connect({}); });
  Subscription handler;
  if (has_parcels) {
    attempts.attempt([&] { handler = parcels.on_packet([](const VarValue&) {}); });
  }
  if (has_samples) samples.ask_for_acknowledgements();
  attempts.attempt([&] { streams->fire(); });
  if (has_samples) {
    attempts.attempt([&] { static_cast<void>(samples.send({1, 2, 3})); });
    attempts.attempt([&] { static_cast<void>(samples.receive_for(a_moment)); });
    static_cast<void>(samples.unacknowledged());
  }
  if (has_leaves) attempts.attempt([&] { static_cast<void>(leaves.receive_for(a_moment)); });
  attempts.attempt_async([&] { return streams->samples().async_connect(use_future); });
  if (has_samples) attempts.attempt([&] { samples.close(); });
  if (has_parcels) attempts.attempt([&] { parcels.close(); });
}

void use_wires(Client<robdef::RootStub>& root, Attempts& attempts) {
  std::shared_ptr<robdef::StreamBoardStub> streams;
  if (!attempts.attempt([&] { streams = root->get_streams(); })) return;
  WireConnection<std::array<double, 3>> force;
  WireConnection<std::optional<robdef::Tree>> state;
  WireConnection<Array<robdef::Sample>> blocks;
  const bool has_force = attempts.attempt([&] { force = streams->force().connect(); });
  const bool has_state = attempts.attempt([&] { state = streams->state().connect(); });
  const bool has_blocks = attempts.attempt([&] { blocks = streams->blocks().connect(); });
  Subscription handler;
  if (has_state) {
    attempts.attempt(
        [&] { handler = state.on_in([](const std::optional<robdef::Tree>&, const TimeSpec&) {}); });
  }
  attempts.attempt([&] { streams->fire(); });
  if (has_force) {
    attempts.attempt([&] { force.set_out({1, 2, 3}); });
    attempts.attempt([&] { static_cast<void>(force.wait_in(a_moment)); });
    attempts.attempt([&] { static_cast<void>(force.try_in()); });
  }
  if (has_blocks) attempts.attempt([&] { static_cast<void>(blocks.wait_in(a_moment)); });
  attempts.attempt([&] { static_cast<void>(streams->force().peek_in()); });
  attempts.attempt([&] { static_cast<void>(streams->state().peek_out()); });
  attempts.attempt([&] { streams->force().poke_out({4, 5, 6}); });
  attempts.attempt_async([&] { return streams->blocks().async_peek_in(use_future); });
  if (has_force) attempts.attempt([&] { force.close(); });
}

void use_memories(Client<robdef::RootStub>& root, Attempts& attempts) {
  std::shared_ptr<robdef::StreamBoardStub> streams;
  if (!attempts.attempt([&] { streams = root->get_streams(); })) return;
  constexpr std::array<std::uint64_t, 2> from = {1, 1};
  constexpr std::array<std::uint64_t, 2> count = {3, 2};
  attempts.attempt([&] { static_cast<void>(streams->bytes().length()); });
  attempts.attempt([&] { static_cast<void>(streams->bytes().read(0, 64)); });
  attempts.attempt([&] { streams->bytes().write(8, Array<std::uint8_t>{1, 2, 3}); });
  attempts.attempt([&] { static_cast<void>(streams->grid().dims()); });
  attempts.attempt([&] { static_cast<void>(streams->grid().dim_count()); });
  attempts.attempt([&] { static_cast<void>(streams->grid().read(from, count)); });
  attempts.attempt([&] {
    streams->grid().write(from, MultiArray<double>{{3, 2}, Array<double>(std::size_t{6})});
  });
  attempts.attempt([&] { static_cast<void>(streams->cells().read(2, 4)); });
  attempts.attempt([&] { static_cast<void>(streams->cells().read(20, 4)); });
  attempts.attempt_async([&] { return streams->cells().async_read(0, 2, use_future); });
}

void use_generators(Client<robdef::RootStub>& root, Attempts& attempts) {
  std::shared_ptr<robdef::StreamBoardStub> streams;
  if (!attempts.attempt([&] { streams = root->get_streams(); })) return;
  Generator<std::int32_t> count;
  if (attempts.attempt([&] { count = streams->count(2); })) {
    for (int step = 0; step != 4; ++step) {
      attempts.attempt([&] { static_cast<void>(count.next()); });
    }
  }
  Generator<void, double> take;
  if (attempts.attempt([&] { take = streams->take("ab"); })) {
    attempts.attempt([&] { static_cast<void>(take.next(1.5)); });
    attempts.attempt([&] { take.close(); });
    attempts.attempt([&] { static_cast<void>(take.next(2.5)); });
  }
  Generator<std::optional<robdef::Leaf>, VarValue> exchange;
  if (attempts.attempt([&] { exchange = streams->exchange(); })) {
    attempts.attempt([&] { static_cast<void>(exchange.next(VarValue(1.5))); });
    attempts.attempt_async([&] { return exchange.async_next(VarValue("two"), use_future); });
    attempts.attempt([&] { exchange.abort(); });
  }
  attempts.attempt([&] { static_cast<void>(streams->count(5)); });  // left open
}

void answer_callbacks(Client<robdef::RootStub>& root, Attempts& attempts) {
  std::shared_ptr<robdef::StreamBoardStub> streams;
  if (!attempts.attempt([&] { streams = root->get_streams(); })) return;
  attempts.attempt([&] { streams->ask().set([](std::int32_t number) { return number; }); });
  attempts.attempt([&] {
    streams->ask_leaf().set([](const std::optional<robdef::Leaf>& leaf, const std::string& text) {
      if (text.empty()) throw robdef::ServiceFault("no text");
      return leaf;
    });
  });
  Subscription handler;
  attempts.attempt([&] {
    handler = streams->fired().connect([](std::int32_t, const std::optional<robdef::Tree>&) {});
  });
  attempts.attempt([&] { streams->fire(); });
  attempts.attempt_async([&] { return streams->async_fire(use_future); });
  attempts.attempt([&] { streams->ask().clear(); });
  attempts.attempt([&] { streams->fire(); });
}

void use_session(Client<robdef::RootStub>& root, Attempts& attempts) {
  attempts.attempt([&] { static_cast<void>(root.fetch_attributes()); });
  attempts.attempt([&] { static_cast<void>(root.find_object_type("conformance.child")); });
  attempts.attempt([&] { root.authenticate("user", {{"password", VarValue("secret")}}); });
  attempts.attempt([&] { root.logout(); });
  attempts.attempt([&] { lock(*root); });
  attempts.attempt([&] { unlock(*root); });
  attempts.attempt([&] { enter_monitor(*root, 1ms); });
  attempts.attempt([&] { exit_monitor(*root); });
  static_cast<void>(root.definitions());
  attempts.attempt([&] { root->send_away(); });
}

}  // namespace

std::span<ClientProgram* const> client_programs() {
  static constexpr std::array<ClientProgram*, 13> programs = {
      with_client<get_numbers>,    with_client<get_containers>, with_client<get_records>,
      with_client<call_functions>, with_client<take_errors>,    with_client<find_objects>,
      with_client<take_events>,    with_client<use_pipes>,      with_client<use_wires>,
      with_client<use_memories>,   with_client<use_generators>, with_client<answer_callbacks>,
      with_client<use_session>};
  return programs;
}

}  // namespace rr::fuzz
