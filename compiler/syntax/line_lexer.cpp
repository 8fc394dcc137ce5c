// SPDX-License-Identifier: Apache-2.0
#include "compiler/syntax/line_lexer.hpp"

#include <RobdefLexer.h>

#include <array>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <unordered_map>

namespace robdef::syntax {

enum class ModeChange : std::uint8_t { none, replace, push, pop };

/// What becomes of the characters that led to a state.
struct LexerRule {
  std::size_t type = 0;
  bool is_skipped = false;
  ModeChange change = ModeChange::none;
  std::size_t mode = 0;  ///< replace, push: the next one
};

namespace {

using antlr4::atn::LexerActionType;
using antlr4::dfa::DFAState;
using Lexer = grammar::RobdefLexer;

using StateIndex = std::uint16_t;
constexpr StateIndex no_state = 0;
constexpr StateIndex unknown_state = 1;

// Not const: a getter of the runtime is not.
void add_action(antlr4::atn::LexerAction& action, LexerRule& rule) {
  switch (action.getActionType()) {
    case LexerActionType::TYPE:
      rule.type =
          static_cast<std::size_t>(static_cast<antlr4::atn::LexerTypeAction&>(action).getType());
      return;
    case LexerActionType::SKIP:
      rule.is_skipped = true;
      return;
    case LexerActionType::MODE:
      rule.change = ModeChange::replace;
      rule.mode =
          static_cast<std::size_t>(static_cast<antlr4::atn::LexerModeAction&>(action).getMode());
      return;
    case LexerActionType::PUSH_MODE:
      rule.change = ModeChange::push;
      rule.mode = static_cast<std::size_t>(
          static_cast<antlr4::atn::LexerPushModeAction&>(action).getMode());
      return;
    case LexerActionType::POP_MODE:
      rule.change = ModeChange::pop;
      return;
    default:
      throw std::logic_error("the grammar has a lexer action that LineLexer does not know");
  }
}

// The automaton is asked for states, not for tokens of a text. ANTLR's own streams have data of
// threads, which no shared object can link from Debian's archive.
class Nothing final : public antlr4::CharStream {
 public:
  void consume() override {}
  std::size_t LA(ssize_t /*offset*/) override { return EOF; }
  ssize_t mark() override { return 0; }
  void release(ssize_t /*marker*/) override {}
  std::size_t index() override { return 0; }
  void seek(std::size_t /*index*/) override {}
  std::size_t size() override { return 0; }
  [[nodiscard]] std::string getSourceName() const override { return {}; }
  std::string getText(const antlr4::misc::Interval& /*interval*/) override { return {}; }
  [[nodiscard]] std::string toString() const override { return {}; }
};

/// Asks the generated lexer's automaton for its states.
class Automaton : private antlr4::atn::LexerATNSimulator {
 public:
  explicit Automaton(Lexer& lexer)
      : LexerATNSimulator(lexer.getATN(), simulator(lexer)._decisionToDFA,
                          simulator(lexer).getSharedContextCache()) {}

  DFAState* first(std::size_t mode) {
    _mode = mode;
    return addDFAState(computeStartState(&nothing_, atn.modeToStartState[mode]).release());
  }

  /// Null when no rule of the mode goes on with this character.
  DFAState* after(DFAState* state, unsigned char character, std::size_t mode) {
    _mode = mode;
    DFAState* target = getExistingTargetState(state, character);
    if (target == nullptr) target = computeTargetState(&nothing_, state, character);
    return target == ERROR.get() ? nullptr : target;
  }

 private:
  static antlr4::atn::LexerATNSimulator& simulator(Lexer& lexer) {
    return *lexer.getInterpreter<antlr4::atn::LexerATNSimulator>();
  }

  Nothing nothing_;
};

/// The states of the lexer's automaton that were needed so far.
class StateTable {
 public:
  StateTable() : states_(2) {}

  StateIndex first(std::size_t mode) {
    StateIndex& index = first_[mode];
    if (index == no_state) index = index_of(automaton_.first(mode), mode);
    return index;
  }

  StateIndex after(StateIndex state, unsigned char character) {
    const StateIndex known = states_[state].next[character];
    return known != unknown_state ? known : find(state, character);
  }

  /// Whether the characters so far are a token.
  [[nodiscard]] bool is_accepting(StateIndex state) const { return states_[state].is_accepting; }
  [[nodiscard]] const LexerRule& rule(StateIndex state) const { return states_[state].rule; }

 private:
  struct State {
    std::array<StateIndex, 256> next{};
    DFAState* state = nullptr;
    std::size_t mode = 0;
    bool is_accepting = false;
    LexerRule rule = {};
  };

  StateIndex find(StateIndex from, unsigned char character) {
    const std::size_t mode = states_[from].mode;
    DFAState* const target = automaton_.after(states_[from].state, character, mode);
    const StateIndex index = target == nullptr ? no_state : index_of(target, mode);
    states_[from].next[character] = index;
    return index;
  }

  StateIndex index_of(DFAState* state, std::size_t mode) {
    StateIndex& index = indices_[state];
    if (index != no_state) return index;
    index = static_cast<StateIndex>(states_.size());
    State& added = states_.emplace_back();
    added.next.fill(unknown_state);
    added.state = state;
    added.mode = mode;
    added.is_accepting = state->isAcceptState;
    if (!state->isAcceptState) return index;
    added.rule.type = state->prediction;
    if (state->lexerActionExecutor == nullptr) return index;
    for (const auto& action : state->lexerActionExecutor->getLexerActions()) {
      add_action(*action, added.rule);
    }
    return index;
  }

  Nothing nothing_;
  Lexer lexer_{&nothing_};
  Automaton automaton_{lexer_};
  std::vector<State> states_;
  std::map<std::size_t, StateIndex> first_;
  std::unordered_map<const DFAState*, StateIndex> indices_;
};

// Each thread fills its own, so that reading needs no lock.
StateTable& state_table() {
  thread_local StateTable table;
  return table;
}

}  // namespace

LexedToken LineLexer::next() {
  StateTable& table = state_table();
  while (true) {
    LexedToken token{.type = Lexer::UNEXPECTED, .begin = at_, .end = at_ + 1};
    StateIndex accepted = no_state;
    StateIndex state = table.first(mode_);
    // The line's end counts as one character behind the text.
    for (std::size_t at = at_; at <= text_.size(); ++at) {
      const char character = at < text_.size() ? text_[at] : '\n';
      state = table.after(state, static_cast<unsigned char>(character));
      if (state == no_state) break;
      if (!table.is_accepting(state)) continue;
      accepted = state;
      token.end = at + 1;
    }
    at_ = token.end;
    if (accepted == no_state) return token;
    const LexerRule& rule = table.rule(accepted);
    change_mode(rule);
    if (rule.is_skipped) continue;
    token.type = rule.type;
    return token;
  }
}

void LineLexer::change_mode(const LexerRule& rule) {
  switch (rule.change) {
    case ModeChange::none:
      return;
    case ModeChange::push:
      outer_modes_.push_back(mode_);
      mode_ = rule.mode;
      return;
    case ModeChange::replace:
      mode_ = rule.mode;
      return;
    case ModeChange::pop:
      mode_ = outer_modes_.back();
      outer_modes_.pop_back();
      return;
  }
}

}  // namespace robdef::syntax
