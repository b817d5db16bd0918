# %% [markdown]
# # 3. A paper is checked
#
# Equations of motion in print have misprints. This notebook takes the equations of a paper letter by letter, as they stand in a scan, and asks which
# of them are true. The paper is Luo and Zhao, *Routh's equations for general nonholonomic mechanical systems of variable mass*; its example is a
# particle that loses mass, on a turning frame, and keeps a constant speed by a nonlinear constraint.

# %%
import anholon as an

model = an.load("luo-zhao-example-1-symbolic")
model

# %% [markdown]
# ## The equations as the scan has them
#
# Each line is compared with what follows from the model. *True* means proved: the difference is zero as a formula, by exact arithmetic. *False* means
# that there is a point of the motion at which the two sides differ.

# %%
as_read = model.compare("luo-zhao-example-1.as-read")
as_read

# %% [markdown]
# **The surprise.** The comparison does not only say *false*. Where a few changes of signs, factors or names make a line true, it finds them and proves
# the corrected line. Most of these changes restore what the scan lost: dots of time derivatives, and exponents.

# %%
for line in as_read:
    for suggestion in line.suggestions[:1]:
        for place in suggestion.places:
            print(f"{line.label:10} {place.wrong}   should be   {place.right}")

# %% [markdown]
# With these places restored every line is true.

# %%
restored = model.compare("luo-zhao-example-1.restored")
assert restored.all_true and not as_read.all_true
len(restored)

# %% [markdown]
# ## A proof that can be checked by others
#
# The equations of the paper are one form among many. Anholon proves that the forms agree. The proof comes with a certificate, a text that a second, small
# program checks without the first one.

# %%
proof = model.prove()
proof

# %%
checked = an.verify(proof)
checked

# %% [markdown]
# All forms agree but one: the *vakonomic* equations, which come from a variational principle with the constraint as a side condition. They are known to
# describe another motion, and a number refutes that they agree with the others.

# %%
assert [form.form for form in proof.forms if form.verdict != "proved"] == ["vakonomic"]

# %% [markdown]
# ## Your own equations
#
# Any equation in the names of the model can be compared. Here a sign is wrong in the constraint of a skate (the blade of Chaplygin's sleigh).

# %%
sleigh = an.load("chaplygin-sleigh")
sleigh.compare({"blade": "x'*sin(th) + y'*cos(th) = 0"})
