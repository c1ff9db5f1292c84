FROM python:3.13-slim

RUN useradd --system --uid 10001 --no-create-home --home-dir /nonexistent --shell /usr/sbin/nologin sim3

WORKDIR /srv/sim3

COPY requirements.lock .
RUN pip install --no-cache-dir --disable-pip-version-check --root-user-action=ignore \
    --require-hashes --only-binary :all: -r requirements.lock

COPY . .
# Bytecode is written here: the root filesystem may be read-only later.
RUN python -m compileall -q geometry sims app

ENV PYTHONDONTWRITEBYTECODE=1 \
    PYTHONUNBUFFERED=1 \
    SIM3_HOST=0.0.0.0 \
    SIM3_PORT=8000

USER 10001
EXPOSE 8000

# http.client ignores proxy variables, which schools often set for containers.
HEALTHCHECK --interval=10s --timeout=5s --start-period=20s \
    CMD ["python", "-c", "import http.client, os, sys; c = http.client.HTTPConnection('127.0.0.1', int(os.environ['SIM3_PORT']), timeout=4); c.request('GET', '/healthz'); sys.exit(c.getresponse().status != 200)"]

CMD ["python", "-m", "app"]
