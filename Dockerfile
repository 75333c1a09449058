# The tarball in a container, on systems where it cannot be built or run.
# docker build -t shoal . && docker run --rm shoal run minimal --bus none
FROM debian:12 AS build
COPY tools/setup tools/apt-packages.txt /src/tools/
RUN /src/tools/setup --for release && rm -rf /var/lib/apt/lists/*
COPY . /src
RUN /src/tools/package tarball && mkdir /opt/shoal && \
    tar -C /opt/shoal --strip-components=1 -xf /src/build/release/packages/shoal-*.tar.xz
FROM debian:12-slim
COPY --from=build /opt/shoal /opt/shoal
WORKDIR /work
ENTRYPOINT ["/opt/shoal/bin/shoal"]
