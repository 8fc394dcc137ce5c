// Serves example.empty. Written by robdef once, and yours since: fill in what the members do. When the
// definition changes, run robdef again: example_empty.h says which members there are then.
#include <Robdef.h>

#include "example_empty.h"

class Nothing {
 public:

 private:
};

Nothing root;
::example::empty::NothingService<Nothing> service(root);

void setup() {
  Serial.begin(115200);
  service.begin(Serial);
}

void loop() {
  service.poll();
}
