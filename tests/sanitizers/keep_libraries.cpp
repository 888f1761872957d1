// Preloaded under the address sanitizer: libraries stay loaded until the process ends, so that what leaks has a name.
extern "C" int dlclose(void* /*library*/) { return 0; }
