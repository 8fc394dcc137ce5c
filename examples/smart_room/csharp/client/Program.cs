// SPDX-License-Identifier: Apache-2.0
// Does with the smart room what the paper does from MATLAB: connects by URL, sets lamps, reads
// sensors, takes a picture.
using System;
using System.Globalization;
using Robdef.Runtime;
using RobotCameraHostInterface;

namespace SmartRoom;

internal static class Program
{
    private const string Usage = """
        usage: smart_room_client [URL] [--picture FILE.png]
        Uses the smart room at URL (default tcp://localhost:6257/RobotCameraHost/CameraHost).
        """;

    private static int Main(string[] arguments)
    {
        string url = "tcp://localhost:6257/RobotCameraHost/CameraHost";
        string pictureFile = "";
        for (int i = 0; i < arguments.Length; ++i)
        {
            if (arguments[i] == "--picture" && i + 1 < arguments.Length)
            {
                pictureFile = arguments[++i];
            }
            else if (!arguments[i].StartsWith('-'))
            {
                url = arguments[i];
            }
            else
            {
                Console.Error.WriteLine(Usage);
                return 2;
            }
        }
        try
        {
            Use(url, pictureFile);
            return 0;
        }
        catch (RobdefException error)
        {
            Console.Error.WriteLine($"smart_room_client: {error.Name}: {error.Message}");
            return 1;
        }
    }

    private static void Use(string url, string pictureFile)
    {
        using var node = new Node();
        using Client<CameraHostStub> client = node.Connect<CameraHostStub>(url);
        ICameraHost smartRoom = client.Root;
        Console.WriteLine($"connected to {url}: {smartRoom.GetRobotDeviceCount()} devices, {smartRoom.GetRobotCameraCount()} cameras");

        IRobotDevice lights = smartRoom.GetRobdevice(0);
        IRobotDevice sensors = smartRoom.GetRobdevice(1);
        IRobotCamera camera = smartRoom.GetRobcamera(2);
        Console.WriteLine($"device 0 is `{lights.GetName()}`, device 1 is `{sensors.GetName()}`, camera 2 is `{camera.GetName()}`");

        PrintColors("sensors before", sensors.GetProperty("ReadRGB"));
        lights.SetProperty("SetRGBRange", [1, 2, 0.7, 0.3, 0]);
        Console.WriteLine("lamps 1 to 2 set to red 0.7, green 0.3, blue 0");
        PrintColors("sensors after", sensors.GetProperty("ReadRGB"));

        CameraBitmap frame = camera.GetCurrentStreamFrameCameraBitmap()
            ?? throw new RobdefException(ErrorCode.NullValue, "the camera gave no picture");
        Console.WriteLine($"a picture of {frame.Width} x {frame.Height} pixels");
        if (pictureFile.Length != 0)
        {
            PngFile.Write(pictureFile, frame.Width, frame.Height, frame.Data);
            Console.WriteLine($"written to {pictureFile}");
        }

        try
        {
            lights.SetProperty("SetRGBRange", [1, 99, 0, 0, 0]);
        }
        catch (RobdefException error)
        {
            Console.WriteLine($"lamp 99 is refused by the service: {error.Name}: {error.Message}");
        }
    }

    private static void PrintColors(string what, double[] values)
    {
        Console.WriteLine($"{what}:");
        for (int i = 0; i + 2 < values.Length; i += 3)
        {
            Console.WriteLine(string.Create(CultureInfo.InvariantCulture,
                $"  {i / 3}  red {values[i]:F3}  green {values[i + 1]:F3}  blue {values[i + 2]:F3}"));
        }
    }
}
