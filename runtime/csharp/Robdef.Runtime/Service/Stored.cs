// SPDX-License-Identifier: Apache-2.0
using System.Collections.Concurrent;
using System.Threading;
using System.Threading.Tasks;

namespace Robdef.Runtime;

/// <summary>A property that is stored, behind its own lock.</summary>
/// <typeparam name="T">The value.</typeparam>
public sealed class Stored<T>(T value)
{
    private readonly Lock _lock = new();
    private T _value = value;

    /// <summary>The value.</summary>
    public T Value
    {
        get
        {
            lock (_lock)
            {
                return _value;
            }
        }

        set
        {
            lock (_lock)
            {
                _value = value;
            }
        }
    }

    /// <summary>The value, for a member.</summary>
    public ValueTask<T> GetAsync() => new(Value);

    /// <summary>Sets the value, for a member.</summary>
    public ValueTask SetAsync(T value)
    {
        Value = value;
        return default;
    }
}

/// <summary>A property of which each client has a value of its own.</summary>
/// <typeparam name="T">The value.</typeparam>
public sealed class StoredPerClient<T>(T first)
{
    private readonly ConcurrentDictionary<uint, T> _values = new();

    /// <summary>The value of the client whose request this thread handles.</summary>
    public T Value
    {
        get => _values.TryGetValue(Skeleton.RrCurrentClient, out T? value) ? value : first;
        set => _values[Skeleton.RrCurrentClient] = value;
    }

    /// <summary>Forgets the value of a client, which has left.</summary>
    public void Forget(uint client) => _values.TryRemove(client, out _);

    /// <summary>The value, for a member.</summary>
    public ValueTask<T> GetAsync() => new(Value);

    /// <summary>Sets the value, for a member.</summary>
    public ValueTask SetAsync(T value)
    {
        Value = value;
        return default;
    }
}
