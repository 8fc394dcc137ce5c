function image = CameraBitmapToImage(bitmap)
%CAMERABITMAPTOIMAGE A picture of a camera as an image: rows x columns x 3.
%   bitmap has width, height, and three bytes a pixel in rows from the top, as the cameras of
%   RobotCameraHost give them.
  width = double(bitmap.width);
  height = double(bitmap.height);
  if numel(bitmap.data) ~= 3 * width * height
    error('the bitmap has %d bytes for %d x %d pixels', numel(bitmap.data), width, height);
  end
  image = permute(reshape(bitmap.data, 3, width, height), [3 2 1]);
end
