// SPDX-License-Identifier: Apache-2.0
using System;
using System.Globalization;
using System.Runtime.InteropServices;
using System.Threading;
using Robdef.Runtime;

namespace SmartRoom;

internal static class Program
{
    private const string Usage = """
        usage: smart_room_service [--port N] [--seconds N] [--everywhere]
        Serves the simulated smart room until it is interrupted, or for so many seconds.
          --port N      TCP port, 0 for any free one (default 6257)
          --everywhere  for clients of other machines, too; without it of this one only
        """;

    private static int Main(string[] arguments)
    {
        int port = 6257;
        int seconds = 0;
        bool isEverywhere = Array.IndexOf(arguments, "--everywhere") >= 0;
        arguments = Array.FindAll(arguments, argument => argument != "--everywhere");
        for (int i = 0; i < arguments.Length; i += 2)
        {
            if (i + 1 == arguments.Length
                || !int.TryParse(arguments[i + 1], NumberStyles.None, CultureInfo.InvariantCulture, out int value)
                || arguments[i] is not ("--port" or "--seconds") || (arguments[i] == "--port" && value > 65535))
            {
                Console.Error.WriteLine(Usage);
                return 2;
            }
            _ = arguments[i] == "--port" ? port = value : seconds = value;
        }
        try
        {
            Serve(port, isEverywhere, seconds > 0 ? TimeSpan.FromSeconds(seconds) : Timeout.InfiniteTimeSpan);
            return 0;
        }
        catch (RobdefException error)
        {
            Console.Error.WriteLine($"smart_room_service: {error.Name}: {error.Message}");
            return 1;
        }
    }

    private static void Serve(int port, bool isEverywhere, TimeSpan time)
    {
        using var stop = new ManualResetEventSlim();
        void Stop(PosixSignalContext signal)
        {
            signal.Cancel = true;
            stop.Set();
        }
        using var interrupted = PosixSignalRegistration.Create(PosixSignal.SIGINT, Stop);
        using var terminated = PosixSignalRegistration.Create(PosixSignal.SIGTERM, Stop);

        using var node = new Node(new NodeOptions { Name = "RobotCameraHost" });
        using Service service = node.Register("CameraHost", new Host(new Room()));
        port = node.Listen($"rr+tcp://{(isEverywhere ? "*" : "localhost")}:{port}");
        Console.Error.WriteLine($"listens at port {port} of "
            + (isEverywhere ? "all interfaces" : "this machine; --everywhere opens it to others"));
        Console.WriteLine($"ready: tcp://localhost:{port}/RobotCameraHost/CameraHost");
        stop.Wait(time);
    }
}
