function smart_room_client(url, picture)
%SMART_ROOM_CLIENT The session of the 2011 paper: lights, a camera, and its picture as a file.
%   smart_room_client('tcp://localhost:6257/RobotCameraHost/CameraHost', 'room.png')
  smartroom = RobotRaconteur.Connect(url);
  lights = smartroom.get_robdevice(int32(0));
  cam = smartroom.get_robcamera(int32(0));
  fprintf('%d devices, %d cameras\n', smartroom.RobotDeviceCount, smartroom.RobotCameraCount);
  fprintf('device 0 is `%s`, camera 0 is `%s`\n', lights.Name, cam.Name);

  before = CameraBitmapToImage(cam.GetCurrentStreamFrameCameraBitmap);
  lights.SetProperty('SetRGBRange', [1, 2, 0.7, 0.3, 0]);
  I = CameraBitmapToImage(cam.GetCurrentStreamFrameCameraBitmap);
  rgb = reshape(lights.GetProperty('GetRGB'), 3, []);
  fprintf('lamps 1 and 2 are at %.1f %.1f %.1f\n', rgb(:, 1));
  changed = any(before ~= I, 3);
  fprintf('%.0f %% of the pixels have changed\n', 100 * mean(changed(:)));
  try
    lights.SetProperty('SetRGBRange', [99, 99, 0, 0, 0]);
  catch err
    fprintf('lamp 99 is refused by the service: %s: %s\n', err.identifier, err.message);
  end

  imwrite(I, picture);
  fprintf('a picture of %d x %d pixels is in %s\n', size(I, 2), size(I, 1), picture);
  if exist('imshow') && ~isempty(getenv('DISPLAY'))
    imshow(I);
  end
end
