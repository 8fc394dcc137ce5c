// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "rr/async/calls.hpp"
#include "rr/async/connecting.hpp"
#include "rr/async/generators.hpp"
#include "rr/async/memories.hpp"
#include "rr/async/streams.hpp"

/// The asynchronous forms of calls, for any completion token of Boost.Asio: a callback, use_future,
/// use_awaitable. The only header that brings Asio; a program that uses no `async_` member does
/// without it.
///
///   mount->async_move_to(0.5, 0.1, [](std::exception_ptr error) { ... });
///   std::future<double> pan = mount->async_get_pan(boost::asio::use_future);
///   double tilt = co_await mount->async_get_tilt(boost::asio::use_awaitable);
///
/// A completion has the signature void(std::exception_ptr) or void(std::exception_ptr, T). It runs
/// on the handler's associated executor, which has work to do until then; without one, on a thread
/// of the node, where it should not take long. The stub must live until the call has been started;
/// what is passed is copied or sent before that.
namespace rr {}
