#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Prints the figures that test_hmm_learning.cpp compares with, from hmmlearn:

  /usr/bin/python3 -m venv venv && venv/bin/pip install hmmlearn==0.3.3
  venv/bin/python src/prf_decision/test/hmmlearn_reference.py
"""
import numpy as np
from hmmlearn.hmm import GaussianHMM

ITERATIONS = 5


def velocities():
    k = np.arange(300)
    size = np.array([0.08, 0.2, 0.45])[k // 37 % 3]
    return size[:, None] * np.column_stack(
        [np.sin(1.3 * k + 0.2), np.cos(2.1 * k), np.sin(0.01 * k * k + 0.7 * k)])


def skewed(iterations):
    # Without priors, as ours: maximum likelihood.
    model = GaussianHMM(3, "full", covars_prior=0.0, covars_weight=1.0, means_prior=0.0,
                        means_weight=0.0, n_iter=iterations, tol=-np.inf, init_params="")
    model.startprob_ = np.array([0.5, 0.3, 0.2])
    model.transmat_ = np.array([[0.7, 0.2, 0.1], [0.25, 0.6, 0.15], [0.05, 0.35, 0.6]])
    model.means_ = np.array([[0.01, 0, -0.02], [0.1, 0.05, 0], [-0.2, 0.1, 0.3]])
    model.covars_ = np.array([
        [[0.02, 0.004, 0], [0.004, 0.01, 0.001], [0, 0.001, 0.015]],
        [[0.05, -0.01, 0.02], [-0.01, 0.08, 0], [0.02, 0, 0.06]],
        [[0.2, 0.05, 0.03], [0.05, 0.3, -0.04], [0.03, -0.04, 0.25]]])
    return model


def show(name, values):
    print(f"{name}: " + ", ".join(f"{value:.12g}" for value in np.ravel(values)))


def main():
    observed = velocities()
    model = skewed(ITERATIONS)
    show("ln P", [model.score(observed)])
    log_probability, states = model.decode(observed)
    show("Viterbi ln P", [log_probability])
    print("Viterbi states: " + "".join(str(state) for state in states))
    show("posterior of observation 150", model.predict_proba(observed)[150])
    model.fit(observed)
    show(f"ln P before each of {ITERATIONS} iterations", list(model.monitor_.history))
    show("initial", model.startprob_)
    show("transition", model.transmat_)
    show("mean", model.means_)
    for index, covariance in enumerate(model.covars_):
        show(f"covariance {index}", covariance)


if __name__ == "__main__":
    main()
