// SPDX-License-Identifier: Apache-2.0
// LightClient URL: uses a light by its URL, as runtime/arduino/bench/light/light_client.cpp does, with the same asserts.
// It cannot tell whether a board or a service of a computer is there.
using System;
using System.Collections.Concurrent;
using System.Diagnostics;
using System.Linq;
using System.Threading;
using Example.Light;
using Robdef.Runtime;

if (args.Length != 1)
{
    Console.Error.WriteLine("usage: LightClient URL");
    return 2;
}
var check = new Checks();
using (var node = new Node())
using (Client<LightStub> client = node.Connect<LightStub>(args[0]))
using (Client<LightStub> another = node.Connect<LightStub>(args[0]))
{
    LightStub light = client.Root;

    var color = new Color { Red = 0.7f, Green = 0.3f, Blue = 0.1f };
    light.SetColor(color);
    check.That(light.GetColor() == color, "keeps its colour");
    check.Raises(ErrorCode.OutOfRange, () => light.SetColor(new Color { Green = 1.25f }), "refuses what is no colour");
    check.Raises(ErrorCode.NullValue, () => light.SetColor(null), "refuses a null");
    check.That(light.GetColor() == color, "keeps its colour after what it refused");

    check.That(IsHalf(light.GetBrightness()), "sees light");
    check.That(IsHalf(light.Sensor.PeekInValue().Value), "has a wire that can be peeked at");
    var sensed = new ConcurrentQueue<double>();
    using (WireConnection<double> wire = light.Sensor.Connect())
    {
        wire.ValueChanged += (value, _) => sensed.Enqueue(value);
        check.Eventually(() => sensed.Count >= 3, "sends values by its wire");
        check.That(sensed.All(IsHalf), "sends what it sees");
    }

    var faded = new ConcurrentQueue<Color?>();
    var fadedToo = new ConcurrentQueue<Color?>();
    light.Faded += faded.Enqueue;
    another.Root.Faded += fadedToo.Enqueue;
    var target = new Color { Red = 1, Green = 0.5f, Blue = 0.25f };
    light.SetColor(new Color());
    light.Fade(target, 0.2);
    check.Eventually(() => !faded.IsEmpty && !fadedToo.IsEmpty, "tells all clients when a fade has ended");
    check.That(faded.SequenceEqual([target]) && fadedToo.SequenceEqual([target]), "tells them once, with the colour");
    check.That(another.Root.GetColor() == target, "has the colour that it has faded to");

    check.Raises(ErrorCode.OutOfRange, () => light.Fade(new Color(), 61), "refuses a fade of more than a minute");
    check.Raises(ErrorCode.OutOfRange, () => light.Fade(new Color(), -0.5), "refuses a fade into the past");
    check.Raises(ErrorCode.OutOfRange, () => light.Fade(new Color { Blue = -1 }, 1), "refuses a fade to no colour");
}
return check.HaveFailed ? 1 : 0;

// Half of what the sensor can see, which is what the test bench shows it.
static bool IsHalf(double lux) => Math.Abs(lux - 255.5) <= 1;

internal sealed class Checks
{
    public bool HaveFailed { get; private set; }

    public void That(bool holds, string what)
    {
        Console.WriteLine($"{(holds ? "ok" : "FAILED")}: a light {what}");
        HaveFailed |= !holds;
    }

    public void Raises(ErrorCode code, Action action, string what)
    {
        ErrorCode raised = ErrorCode.None;
        try
        {
            action();
        }
        catch (RobdefException error)
        {
            raised = error.Code;
        }
        That(raised == code, what);
    }

    public void Eventually(Func<bool> holds, string what)
    {
        var spent = Stopwatch.StartNew();
        while (!holds() && spent.Elapsed < TimeSpan.FromSeconds(20))
        {
            Thread.Sleep(1);
        }
        That(holds(), what);
    }
}
