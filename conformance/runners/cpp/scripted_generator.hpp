// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <rr/generators.hpp>
#include <utility>

#include "conformance/runners/cpp/adapters.hpp"
#include "conformance/runners/cpp/outcomes.hpp"

namespace rr::conformance {

/// The steps that a script tells: `yield` values or `accept` so many, then the end, or instead of
/// it the error `end`.
class ScriptedSteps {
 public:
  ScriptedSteps(const Adapters& adapters, Json script)
      : adapters_(adapters), script_(std::move(script)) {}

  /// False at the end.
  bool take() {
    if (step_ < count()) {
      ++step_;
      return true;
    }
    if (script_.contains("end")) raise(adapters_, script_["end"]);
    return false;
  }
  /// What the next step gives; nothing at the end.
  template <class R>
  std::optional<R> give() {
    const std::size_t step = step_;
    if (!take()) return std::nullopt;
    return made_from_json<R>(adapters_, script_.at("yield").at(step));
  }

 private:
  [[nodiscard]] std::size_t count() const {
    return script_.contains("yield") ? script_["yield"].size() : script_.value("accept", 0U);
  }

  const Adapters& adapters_;
  const Json script_;
  std::size_t step_ = 0;
};

/// A generator that does what its script says.
template <class R, class P>
class ScriptedGenerator final : public GeneratorOf<R, P> {
 public:
  ScriptedGenerator(const Adapters& adapters, Json script) : steps_(adapters, std::move(script)) {}
  std::optional<R> next(const P&) override { return steps_.give<R>(); }

 private:
  ScriptedSteps steps_;
};

template <class P>
class ScriptedGenerator<void, P> final : public GeneratorOf<void, P> {
 public:
  ScriptedGenerator(const Adapters& adapters, Json script) : steps_(adapters, std::move(script)) {}
  bool next(const P&) override { return steps_.take(); }

 private:
  ScriptedSteps steps_;
};

template <class R>
class ScriptedGenerator<R, void> final : public GeneratorOf<R, void> {
 public:
  ScriptedGenerator(const Adapters& adapters, Json script) : steps_(adapters, std::move(script)) {}
  std::optional<R> next() override { return steps_.give<R>(); }

 private:
  ScriptedSteps steps_;
};

}  // namespace rr::conformance
