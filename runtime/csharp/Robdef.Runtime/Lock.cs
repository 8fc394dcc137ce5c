// SPDX-License-Identifier: Apache-2.0
#if !NET9_0_OR_GREATER
namespace System.Threading;

/// <summary>What .NET has from version 9 on, as far as the statement `lock` needs it.</summary>
internal sealed class Lock
{
    private readonly object _held = new();

    public Scope EnterScope()
    {
        Monitor.Enter(_held);
        return new Scope(_held);
    }

    public readonly ref struct Scope(object held)
    {
        public void Dispose() => Monitor.Exit(held);
    }
}
#endif
