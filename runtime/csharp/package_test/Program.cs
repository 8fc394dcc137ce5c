// SPDX-License-Identifier: Apache-2.0
using System;
using System.Threading;
using System.Threading.Tasks;
using Example.Counter;
using Example.Units;
using Robdef.Runtime;

using var node = new Node();
int port = node.Listen("rr+tcp://127.0.0.1:0");
using Service service = node.Register("counter", new Counter());
using Client<CounterStub> client = node.Connect<CounterStub>($"rr+tcp://127.0.0.1:{port}/?service=counter");
client.Root.Add(1);
Console.WriteLine($"counted to {(await client.Root.AddAsync(2))!.Number}");

internal sealed class Counter : CounterSkeleton
{
    private int _number;

    public override ValueTask<Count?> AddAsync(int steps, CancellationToken cancellationToken)
    {
        _number += steps * Constants.Step;
        return new(new Count { Number = _number });
    }
}
