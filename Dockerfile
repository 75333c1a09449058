# The shoal program with its worlds.  docker build -t shoal . && docker run --rm shoal run minimal --bus none
FROM debian:12
COPY tools/setup tools/apt-packages.txt /src/tools/
RUN /src/tools/setup --for run && rm -rf /var/lib/apt/lists/*
COPY . /src
RUN /src/tools/build --for run programs && cmake --install /src/build/release --prefix /usr/local && rm -rf /src/build
ENTRYPOINT ["shoal"]
