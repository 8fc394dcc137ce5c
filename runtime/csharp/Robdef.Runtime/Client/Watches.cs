// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Threading;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>Handlers of events, each with its native subscription.</summary>
internal sealed class Watches
{
    private readonly Lock _lock = new();
    private readonly List<(string Event, Delegate Handler, SubscriptionHandle Subscription)> _all = [];

    public void Add(string name, Delegate handler, SubscriptionHandle subscription)
    {
        lock (_lock)
        {
            _all.Add((name, handler, subscription));
        }
    }

    /// <summary>When that returns the handler does not run, unless this is called by it.</summary>
    public void Remove(string name, Delegate? handler)
    {
        SubscriptionHandle? subscription = null;
        lock (_lock)
        {
            int found = _all.FindLastIndex(one => one.Event == name && one.Handler.Equals(handler));
            if (found >= 0)
            {
                subscription = _all[found].Subscription;
                _all.RemoveAt(found);
            }
        }
        subscription?.Dispose();
    }

    public void Clear()
    {
        (string Event, Delegate Handler, SubscriptionHandle Subscription)[] all;
        lock (_lock)
        {
            all = [.. _all];
            _all.Clear();
        }
        foreach (var one in all)
        {
            one.Subscription.Dispose();
        }
    }
}
