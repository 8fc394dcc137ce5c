// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <rr/generators.hpp>
#include <utility>

#include "conformance/runners/shared/adapters.hpp"
#include "conformance/runners/shared/object_script.hpp"

namespace rr::conformance {

/// What the next step gives; nothing at the end.
template <class R>
std::optional<R> give(const Adapters& adapters, ScriptedSteps& steps) {
  const std::optional<Json> value = steps.give();
  if (!value) return std::nullopt;
  return made_from_json<R>(adapters, *value);
}

/// A generator that does what its script says.
template <class R, class P>
class ScriptedGenerator final : public GeneratorOf<R, P> {
 public:
  ScriptedGenerator(const Adapters& adapters, ScriptedSteps steps)
      : adapters_(adapters), steps_(std::move(steps)) {}
  std::optional<R> next(const P&) override { return give<R>(adapters_, steps_); }

 private:
  const Adapters& adapters_;
  ScriptedSteps steps_;
};

template <class P>
class ScriptedGenerator<void, P> final : public GeneratorOf<void, P> {
 public:
  ScriptedGenerator(const Adapters&, ScriptedSteps steps) : steps_(std::move(steps)) {}
  bool next(const P&) override { return steps_.take(); }

 private:
  ScriptedSteps steps_;
};

template <class R>
class ScriptedGenerator<R, void> final : public GeneratorOf<R, void> {
 public:
  ScriptedGenerator(const Adapters& adapters, ScriptedSteps steps)
      : adapters_(adapters), steps_(std::move(steps)) {}
  std::optional<R> next() override { return give<R>(adapters_, steps_); }

 private:
  const Adapters& adapters_;
  ScriptedSteps steps_;
};

}  // namespace rr::conformance
