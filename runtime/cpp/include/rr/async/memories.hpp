// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <exception>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "rr/async/completion.hpp"
#include "rr/memories.hpp"
#include "rr/visibility.hpp"

/// Memories; see rr/async.hpp.
namespace RR_VISIBLE rr {

template <class T>
template <class Token>
auto ArrayMemory<T>::async_read(std::uint64_t position, std::uint64_t count,
                                const CallOptions& options, Token&& token) const {
  return boost::asio::async_initiate<Token, void(std::exception_ptr, Array<T>)>(
      [memory = *this, position, count, options](auto&& handler) {
        using Handler = std::decay_t<decltype(handler)>;
        auto completion = std::make_unique<CallCompletion<Handler, Array<T>>>(
            std::forward<decltype(handler)>(handler));
        auto& items = *static_cast<Array<T>*>(completion->result());
        items = Array<T>(size_of({&count, 1}));
        start_call(std::move(completion), options, [&](auto ending) {
          memory.start_read({&position, 1}, {&count, 1}, items.mutate().data(), items.size(),
                            std::move(ending));
        });
      },
      token);
}

template <class T>
template <class Token>
auto ArrayMemory<T>::async_write(std::uint64_t position, const Array<T>& items,
                                 const CallOptions& options, Token&& token) const {
  return boost::asio::async_initiate<Token, void(std::exception_ptr)>(
      [memory = *this, position, options](auto&& handler, const Array<T>& kept) {
        using Handler = std::decay_t<decltype(handler)>;
        const std::uint64_t count = kept.size();
        start_call(std::make_unique<CallCompletion<Handler, void>>(
                       std::forward<decltype(handler)>(handler)),
                   options, [&](auto completion) {
                     memory.start_write({&position, 1}, {&count, 1}, kept.data(), kept.size(),
                                        kept.owner(), std::move(completion));
                   });
      },
      token, items.owner() ? items : Array<T>(std::span<const T>(items)));
}

template <class T>
template <class Token>
auto MultiMemory<T>::async_read(std::vector<std::uint64_t> position,
                                std::vector<std::uint64_t> count, const CallOptions& options,
                                Token&& token) const {
  return boost::asio::async_initiate<Token, void(std::exception_ptr, MultiArray<T>)>(
      [memory = *this, options](auto&& handler, const std::vector<std::uint64_t>& where,
                                const std::vector<std::uint64_t>& shape) {
        using Handler = std::decay_t<decltype(handler)>;
        auto completion = std::make_unique<CallCompletion<Handler, MultiArray<T>>>(
            std::forward<decltype(handler)>(handler));
        auto& array = *static_cast<MultiArray<T>*>(completion->result());
        array = {{shape.begin(), shape.end()}, Array<T>(size_of(shape))};
        start_call(std::move(completion), options, [&](auto ending) {
          memory.start_read(where, shape, array.items.mutate().data(), array.items.size(),
                            std::move(ending));
        });
      },
      token, std::move(position), std::move(count));
}

template <class T>
template <class Token>
auto MultiMemory<T>::async_write(std::vector<std::uint64_t> position, const MultiArray<T>& array,
                                 const CallOptions& options, Token&& token) const {
  return boost::asio::async_initiate<Token, void(std::exception_ptr)>(
      [memory = *this, options](auto&& handler, const std::vector<std::uint64_t>& where,
                                const std::vector<std::uint64_t>& shape, const Array<T>& kept) {
        using Handler = std::decay_t<decltype(handler)>;
        start_call(std::make_unique<CallCompletion<Handler, void>>(
                       std::forward<decltype(handler)>(handler)),
                   options, [&](auto completion) {
                     memory.start_write(where, shape, kept.data(), kept.size(), kept.owner(),
                                        std::move(completion));
                   });
      },
      token, std::move(position), std::vector<std::uint64_t>(array.dims.begin(), array.dims.end()),
      array.items.owner() ? array.items : Array<T>(std::span<const T>(array.items)));
}

}  // namespace rr
