/// Mesa's llvmpipe as a peer, by OSMesa.
#define GL_GLEXT_PROTOTYPES
#include <GL/osmesa.h>
// Must come after osmesa.h.
#include <GL/glext.h>

#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <vector>

#include <hedgerow/queries/hit.h>
#include <hedgerow/render/camera/ray_maker.h>

#include "rasterisers.h"

namespace hedgerow {
namespace {

constexpr const char* vertex_shader = R"(#version 330 core
in vec3 position;
uniform mat4 to_clip;
void main() { gl_Position = to_clip * vec4(position, 1); })";
constexpr const char* fragment_shader = R"(#version 330 core
out uint element;
void main() { element = uint(gl_PrimitiveID); })";

/// The matrix of RayMaker's picture, by columns, for depths from `near` to `far` forward of the eye.
std::vector<float> clip_matrix(const PicturePlane& plane, int width, int height, float near, float far) {
    const float x = 2 / (plane.scale * static_cast<float>(width)),
                y = 2 / (plane.scale * static_cast<float>(height));
    const float a = (far + near) / (far - near), b = -2 * far * near / (far - near);
    std::vector<float> m(16);
    for (int k = 0; k < 3; ++k) {
        float* const column = &m[static_cast<std::size_t>(4 * k)];
        column[0] = x * plane.right[k], column[1] = y * plane.up[k];
        column[2] = a * plane.forward[k], column[3] = plane.forward[k];
    }
    m[12] = -x * dot(plane.right, plane.eye), m[13] = -y * dot(plane.up, plane.eye);
    m[14] = b - a * dot(plane.forward, plane.eye), m[15] = -dot(plane.forward, plane.eye);
    return m;
}

class Mesa final : public RasterPeer {
public:
    Mesa(const TriangleMesh<float>& mesh, const Camera& camera, int width, int height)
        : width_(width), height_(height), corners_(3 * mesh.size()), bytes_(4 * pixels()) {
        setenv("LP_NUM_THREADS", "0", 0);
        const int wanted[] = {OSMESA_FORMAT,
                              OSMESA_RGBA,
                              OSMESA_DEPTH_BITS,
                              32,
                              OSMESA_PROFILE,
                              OSMESA_CORE_PROFILE,
                              OSMESA_CONTEXT_MAJOR_VERSION,
                              3,
                              OSMESA_CONTEXT_MINOR_VERSION,
                              3,
                              0};
        context_ = OSMesaCreateContextAttribs(wanted, nullptr);
        expect(context_ != nullptr &&
                   OSMesaMakeCurrent(context_, bytes_.data(), GL_UNSIGNED_BYTE, width, height),
               "no context");
        make_program();
        make_arrays(mesh);
        make_targets();
        const auto plane = RayMaker(camera, width, height).plane();
        float far = 0;
        for (const auto& v : mesh.vertices) far = std::max(far, dot(v - plane.eye, plane.forward));
        const auto matrix = clip_matrix(plane, width, height, far * 1e-4f, far * 1.01f);
        glUniformMatrix4fv(glGetUniformLocation(program_, "to_clip"), 1, GL_FALSE, matrix.data());
        glViewport(0, 0, width, height);
        glEnable(GL_DEPTH_TEST);
        expect(glGetError() == GL_NO_ERROR, "it cannot be set up");
    }
    ~Mesa() override { OSMesaDestroyContext(context_); }
    std::string name() const override { return "Mesa llvmpipe"; }
    void draw() override {
        const GLuint none[4] = {Hit<float>::none};
        const float farthest = 1;
        glClearBufferuiv(GL_COLOR, 0, none);
        glClearBufferfv(GL_DEPTH, 0, &farthest);
        glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(corners_), GL_UNSIGNED_INT, nullptr);
        glFinish();
    }
    void read(std::span<std::uint32_t> elements) override {
        std::vector<std::uint32_t> upward(pixels());
        glReadPixels(0, 0, width_, height_, GL_RED_INTEGER, GL_UNSIGNED_INT, upward.data());
        const auto row = static_cast<std::size_t>(width_);
        for (std::size_t i = 0; i < upward.size(); ++i)
            elements[(static_cast<std::size_t>(height_) - 1 - i / row) * row + i % row] = upward[i];
    }

private:
    static void expect(bool holds, const char* fault) {
        if (!holds) throw std::runtime_error(std::string("Mesa: ") + fault);
    }
    std::size_t pixels() const {
        return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    }

    void make_program() {
        program_ = glCreateProgram();
        for (const auto& [kind, text] :
             {std::pair{GL_VERTEX_SHADER, vertex_shader}, std::pair{GL_FRAGMENT_SHADER, fragment_shader}}) {
            const GLuint shader = glCreateShader(static_cast<GLenum>(kind));
            glShaderSource(shader, 1, &text, nullptr);
            glCompileShader(shader);
            glAttachShader(program_, shader);
        }
        glLinkProgram(program_);
        GLint linked = 0;
        glGetProgramiv(program_, GL_LINK_STATUS, &linked);
        expect(linked != 0, "its shaders do not compile");
        glUseProgram(program_);
    }
    void make_arrays(const TriangleMesh<float>& mesh) {
        GLuint array, buffers[2];
        glGenVertexArrays(1, &array);
        glBindVertexArray(array);
        glGenBuffers(2, buffers);
        glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.vertices.size() * sizeof(Vec3f)),
                     mesh.vertices.data(), GL_STATIC_DRAW);
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
        glBufferData(GL_ELEMENT_ARRAY_BUFFER,
                     static_cast<GLsizeiptr>(mesh.triangles.size() * sizeof(TriangleIndices)),
                     mesh.triangles.data(), GL_STATIC_DRAW);
        const auto place = static_cast<GLuint>(glGetAttribLocation(program_, "position"));
        glEnableVertexAttribArray(place);
        glVertexAttribPointer(place, 3, GL_FLOAT, GL_FALSE, sizeof(Vec3f), nullptr);
    }
    /// Buffers of numbers and of depths, each of 32 bits.
    void make_targets() {
        GLuint frame, targets[2];
        glGenFramebuffers(1, &frame);
        glBindFramebuffer(GL_FRAMEBUFFER, frame);
        glGenRenderbuffers(2, targets);
        glBindRenderbuffer(GL_RENDERBUFFER, targets[0]);
        glRenderbufferStorage(GL_RENDERBUFFER, GL_R32UI, width_, height_);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, targets[0]);
        glBindRenderbuffer(GL_RENDERBUFFER, targets[1]);
        glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, width_, height_);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, targets[1]);
        expect(glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE, "no buffers");
    }

    int width_, height_;
    std::size_t corners_;
    std::vector<unsigned char> bytes_;
    OSMesaContext context_ = nullptr;
    GLuint program_ = 0;
};

}  // namespace

std::unique_ptr<RasterPeer> osmesa(const TriangleMesh<float>& mesh, const Camera& camera, int width,
                                   int height) {
    return std::make_unique<Mesa>(mesh, camera, width, height);
}

}  // namespace hedgerow
