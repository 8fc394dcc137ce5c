// SPDX-License-Identifier: Apache-2.0
// The simulated room as the paper's RobotCameraHost: one host object with devices (lamps and sensors behind one
// general interface) and cameras.
using System.Collections.Generic;
using System.Linq;
using System.Threading;
using System.Threading.Tasks;
using Robdef.Runtime;
using RobotCameraHostInterface;

namespace SmartRoom;

/// <summary>
/// All lamps as one device. Properties: `SetRGBRange` takes first and last lamp (from 1), red, green, blue; `GetRGB`
/// gives three numbers a lamp; `Positions` three coordinates a lamp, in metres.
/// </summary>
internal sealed class Lights(Room room) : RobotDeviceDefault
{
    public override ValueTask<string> GetNameAsync(CancellationToken cancellationToken) => new("RGB lights");

    public override ValueTask<double[]> GetPropertyAsync(string name, CancellationToken cancellationToken) => name switch
    {
        "GetRGB" => new(Host.Numbers(room.Lights)),
        "Positions" => new(Host.Numbers(Room.LightPlaces)),
        _ => throw Host.Refuse($"the lights have no property `{name}` to get"),
    };

    public override ValueTask<int> SetPropertyAsync(string name, double[] val, CancellationToken cancellationToken)
    {
        if (name != "SetRGBRange")
        {
            throw Host.Refuse($"the lights have no property `{name}` to set");
        }
        if (val.Length != 5)
        {
            throw Host.Refuse("SetRGBRange takes first, last, red, green, blue");
        }
        if (!val[2..].All(color => color is >= 0 and <= 1))
        {
            throw Host.Refuse("a color is a number from 0 to 1");
        }
        int first = Lamp(val[0]);
        int last = Lamp(val[1]);
        if (first > last)
        {
            throw Host.Refuse("the first lamp comes behind the last");
        }
        room.SetLights(first, last, new Color(val[2], val[3], val[4]));
        return new(0);
    }

    private static int Lamp(double number) => number >= 1 && number <= Room.LightPlaces.Count && double.IsInteger(number)
        ? (int)number
        : throw Host.Refuse($"lamps are counted from 1 to {Room.LightPlaces.Count}");
}

/// <summary>
/// All color sensors as one device. Properties: `ReadRGB` gives three numbers a sensor; `Positions` three coordinates a
/// sensor, in metres.
/// </summary>
internal sealed class Sensors(Room room) : RobotDeviceDefault
{
    public override ValueTask<string> GetNameAsync(CancellationToken cancellationToken) => new("RGB sensors");

    public override ValueTask<double[]> GetPropertyAsync(string name, CancellationToken cancellationToken) => name switch
    {
        "ReadRGB" => new(Host.Numbers(Room.SensorPlaces.Select((_, index) => room.Sensor(index)))),
        "Positions" => new(Host.Numbers(Room.SensorPlaces)),
        _ => throw Host.Refuse($"the sensors have no property `{name}` to get"),
    };

    public override ValueTask<int> SetPropertyAsync(string name, double[] val, CancellationToken cancellationToken) =>
        throw Host.Refuse($"the sensors have no property `{name}` to set");
}

/// <summary>A ceiling camera. Property: `Position`, in metres.</summary>
internal sealed class Camera(Room room, int index) : RobotCameraDefault
{
    public override ValueTask<string> GetNameAsync(CancellationToken cancellationToken) => new($"ceiling camera {index}");

    public override ValueTask<double[]> GetPropertyAsync(string name, CancellationToken cancellationToken) => name == "Position"
        ? new(Host.Numbers([Room.CameraPlaces[index]]))
        : throw Host.Refuse($"a camera has no property `{name}` to get");

    public override ValueTask<int> SetPropertyAsync(string name, double[] val, CancellationToken cancellationToken) =>
        throw Host.Refuse($"a camera has no property `{name}` to set");

    public override ValueTask<CameraBitmap?> GetCurrentStreamFrameCameraBitmapAsync(CancellationToken cancellationToken) =>
        new(new CameraBitmap { Width = Room.PictureWidth, Height = Room.PictureHeight, Data = room.Picture(index) });
}

internal sealed class Host : CameraHostDefault
{
    private readonly Skeleton[] _devices;
    private readonly Skeleton[] _cameras;

    public Host(Room room)
    {
        _devices = [new Lights(room), new Sensors(room)];
        _cameras = [.. Room.CameraPlaces.Select((_, index) => new Camera(room, index))];
    }

    public override ValueTask<Skeleton> GetRobdeviceAsync(int index, CancellationToken cancellationToken) => new(Find(_devices, index, "device"));

    public override ValueTask<Skeleton> GetRobcameraAsync(int index, CancellationToken cancellationToken) => new(Find(_cameras, index, "camera"));

    public override ValueTask<int> GetRobotDeviceCountAsync(CancellationToken cancellationToken) => new(_devices.Length);

    public override ValueTask<int> GetRobotCameraCountAsync(CancellationToken cancellationToken) => new(_cameras.Length);

    public override ValueTask SetRobotDeviceCountAsync(int value, CancellationToken cancellationToken) => throw Refuse("the number of devices is fixed");

    public override ValueTask SetRobotCameraCountAsync(int value, CancellationToken cancellationToken) => throw Refuse("the number of cameras is fixed");

    internal static RobdefException Refuse(string message) => new InvalidArgumentException(message);

    internal static double[] Numbers(IEnumerable<Color> colors) =>
        [.. colors.SelectMany(color => new[] { color.Red, color.Green, color.Blue })];

    internal static double[] Numbers(IEnumerable<Place> places) => [.. places.SelectMany(place => new[] { place.X, place.Y, place.Z })];

    private static Skeleton Find(Skeleton[] all, int index, string what) => index >= 0 && index < all.Length
        ? all[index]
        : throw Refuse($"there is no {what} {index}");
}
