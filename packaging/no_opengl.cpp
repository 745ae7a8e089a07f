// What OpenCV's archive asks of OpenGL, which nothing here uses: there is none.
extern "C" {
using GlFunction = void (*)();
GlFunction glXGetProcAddressARB(const unsigned char* /*name*/) { return nullptr; }
void* glXGetCurrentContext() { return nullptr; }
void* glXGetCurrentDisplay() { return nullptr; }
}
