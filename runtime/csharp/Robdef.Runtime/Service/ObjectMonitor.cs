// SPDX-License-Identifier: Apache-2.0
using System;
using System.Threading;

namespace Robdef.Runtime;

/// <summary>
/// Keeps an object for one client, or for a piece of work of the service itself. Entered and left on any threads,
/// not twice by one. Held by the object for as long as that is served.
/// </summary>
#pragma warning disable CA1001 // A semaphore without a wait handle has nothing to dispose.
public sealed class ObjectMonitor
{
    private readonly SemaphoreSlim _free = new(1, 1);

    /// <summary>Waits until nobody has the object, for as long as <paramref name="limit"/> says.</summary>
    /// <returns>Whether it is the caller's now.</returns>
    public bool TryEnter(TimeSpan limit) => _free.Wait(limit < TimeSpan.Zero ? Timeout.InfiniteTimeSpan : limit);

    /// <summary>Lets the next one have it.</summary>
    public void Exit() => _free.Release();
}
#pragma warning restore CA1001
